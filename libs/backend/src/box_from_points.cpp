#include "djpete/backend/box_from_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "box_sides.h"

namespace djpete::backend {

namespace {

using geometry::SE3;
using geometry::Vec3;

constexpr double kBeside_m = 0.3;      // points so far outside the box may belong to it
constexpr double kClearance_m = 0.12;  // over the ground
constexpr double kFacing_m = 0.3;      // a scanner this far before a side sees it
constexpr double kGrazing = 0.1;       // ... and not at a smaller angle
constexpr std::size_t kLeastPoints = 20;
constexpr double kEndSigma_m = 0.03, kSideSigma_m = 0.015, kGroundSigma_m = 0.03,
                 kTopSigma_m = 0.03, kHoldSigma_m = 0.02;
constexpr double kBulge_m = 0.08, kGapShare = 0.3;  // of the gap from panels to the outermost
constexpr double kMostUnseen = 0.25;                // of the width at the edges of an end
constexpr int kRounds = 3;

/// One axis of the box: its centre and extent, from a prior and what is known of both sides.
struct Axis {
    Measured centre, extent;
    std::optional<Measured> middle;               // of what was seen of it
    std::array<std::optional<Measured>, 2> side;  // at the low and at the high end

    struct Solved {
        Measured centre, extent;
        std::array<Measured, 2> side;
    };
    Solved solve() const {
        geometry::Mat2 A = geometry::Mat2::Zero();
        geometry::Vec2 b = geometry::Vec2::Zero();
        const auto add = [&](const geometry::Vec2& j, const Measured& m) {
            A += j * j.transpose() / (m.sigma * m.sigma);
            b += j * m.value / (m.sigma * m.sigma);
        };
        const std::array<geometry::Vec2, 2> end{geometry::Vec2(1, -0.5), geometry::Vec2(1, 0.5)};
        add({1, 0}, centre);
        add({0, 1}, extent);
        if (middle) add({1, 0}, *middle);
        for (const int e : {0, 1}) {
            if (side[e]) add(end[e], *side[e]);
        }
        const geometry::Mat2 C = A.inverse();
        const geometry::Vec2 x = C * b;
        const auto linear = [&](const geometry::Vec2& j) {
            return Measured{j.dot(x), std::sqrt(j.dot(C * j))};
        };
        return {linear({1, 0}), linear({0, 1}), {linear(end[0]), linear(end[1])}};
    }
};

/// The present estimate: a frame against the prior's, and a size.
class Fit {
  public:
    Fit(const BoxPoints& in, const BoxPrior& prior)
        : in_(in), prior_(prior), size_(prior.size_m), yawSigma_(prior.yawSigma_rad) {}

    std::optional<BoxFit> run();

  private:
    void choosePoints();
    void turn();
    bool place();
    /// How far a side may be from where the prior has it.
    double slack(int axis) const {
        return 3 * std::hypot(prior_.sigma_m[axis], 0.5 * prior_.sizeSigma_m[axis]);
    }
    bool facing(int axis, int sign) const;
    /// A box holds its points: one that does not is moved or grown.
    Axis::Solved holding(Axis axis, int k) const;
    std::optional<Measured> middleOfEnd() const;
    void dropWeaker(Axis& y);
    std::array<Axis, 3> measure();
    std::optional<Measured> top(const Axis& z) const;

    const BoxPoints& in_;
    const BoxPrior& prior_;
    SE3 T_obj_fit_;
    Vec3 size_;
    double yawSigma_;
    Vec3 sigma_;
    std::optional<double> ground_;  // z in fit
    SidePoints points_;             // in fit
    std::vector<Vec3> origins_;
    std::optional<SideLine> right_, left_;
    BoxFit out_;
};

void Fit::choosePoints() {
    const SE3 T_fit_obj = T_obj_fit_.inverse();
    ground_.reset();
    std::vector<double> heights;
    for (const auto& p : in_.ground) {
        const Vec3 p_fit = T_fit_obj * p.cast<double>();
        if (std::abs(p_fit.x()) < 0.5 * size_.x() + 0.8 &&
            std::abs(p_fit.y()) < 0.5 * size_.y() + 0.8) {
            heights.push_back(p_fit.z());
        }
    }
    if (heights.size() >= 5) {
        const auto middle = heights.begin() + static_cast<long>(heights.size() / 2);
        std::nth_element(heights.begin(), middle, heights.end());
        ground_ = *middle;
    }
    const double floor = ground_ ? *ground_ + kClearance_m : kClearance_m - 0.5 * size_.z();
    points_.clear();
    for (const auto& p : in_.body) {
        const Vec3 p_fit = T_fit_obj * p.cast<double>();
        if (p_fit.z() < floor) continue;
        if ((p_fit.cwiseAbs() - 0.5 * size_).maxCoeff() < kBeside_m) points_.push_back(p_fit);
    }
    origins_.clear();
    for (const auto& p : in_.origins) origins_.push_back(T_fit_obj * p.cast<double>());
}

bool Fit::facing(int axis, int sign) const {
    return std::any_of(origins_.begin(), origins_.end(), [&](const Vec3& p) {
        return sign * p[axis] - 0.5 * size_[axis] > std::max(kFacing_m, kGrazing * p.norm());
    });
}

Axis::Solved Fit::holding(Axis axis, int k) const {
    Axis::Solved now = axis.solve();
    for (const int e : {0, 1}) {
        if (axis.side[e]) continue;
        const int sign = e == 0 ? -1 : 1;
        const Measured& end = now.side[e];
        Outermost outermost;
        for (const auto& p : points_) {
            // What is too far out belongs to something else.
            const double out = sign * (p[k] - end.value);
            if (out < 2 * end.sigma) outermost.add(out);
        }
        const double out = outermost.value();
        if (out <= 0) continue;
        axis.side[e] = Measured{end.value + sign * out, kHoldSigma_m};
        now = axis.solve();
    }
    return now;
}

void Fit::turn() {
    const double search = std::clamp(3 * yawSigma_, 0.02, 0.25);
    right_.reset();
    left_.reset();
    if (facing(1, -1)) right_ = fitSide(points_, -1, size_.y(), search, slack(1));
    if (facing(1, 1)) left_ = fitSide(points_, 1, size_.y(), search, slack(1));
    const double done = T_obj_fit_.yaw_rad();
    double weight = 1 / (prior_.yawSigma_rad * prior_.yawSigma_rad);
    double sum = -done * weight;
    for (const auto* side : {&right_, &left_}) {
        if (!*side) continue;
        const Measured& m = (*side)->turn_rad;
        sum += m.value / (m.sigma * m.sigma);
        weight += 1 / (m.sigma * m.sigma);
    }
    yawSigma_ = 1 / std::sqrt(weight);
    T_obj_fit_ = T_obj_fit_ * SE3::fromYaw(sum / weight, Vec3::Zero());
}

/// Of two long sides that do not belong to one box, the one with less behind it goes.
void Fit::dropWeaker(Axis& y) {
    if (!right_ || !left_) return;
    const double width = y.side[1]->value - y.side[0]->value;
    const double sigma = Vec3(y.side[0]->sigma, y.side[1]->sigma, prior_.sizeSigma_m.y()).norm();
    if (std::abs(width - prior_.size_m.y()) < 2 * sigma) return;
    if (left_->pieces < right_->pieces) {
        left_.reset();
        y.side[1].reset();
    } else {
        right_.reset();
        y.side[0].reset();
    }
}

/// An end seen from one edge to the other says where the middle is, though its edges are round.
std::optional<Measured> Fit::middleOfEnd() const {
    if (right_ || left_ || !(out_.rear || out_.front)) return std::nullopt;
    Outermost low, high;
    for (const auto& p : points_) {
        low.add(-p.y());
        high.add(p.y());
    }
    const double right = -low.value(), left = high.value();
    const double unseen = prior_.size_m.y() - (left - right);
    if (unseen > kMostUnseen * prior_.size_m.y()) return std::nullopt;
    return Measured{0.5 * (left + right), std::hypot(kSideSigma_m, 0.25 * unseen)};
}

std::array<Axis, 3> Fit::measure() {
    const Vec3 p_prior = T_obj_fit_.inverse() * Vec3::Zero();
    std::array<Axis, 3> axes;
    for (int k = 0; k < 3; ++k) {
        axes[k].centre = {p_prior[k], prior_.sigma_m[k]};
        axes[k].extent = {prior_.size_m[k], prior_.sizeSigma_m[k]};
    }
    for (const int e : {0, 1}) {
        const int sign = e == 0 ? -1 : 1;
        if (!facing(0, sign)) continue;
        if (const auto end = fitEnd(points_, sign, size_, slack(0))) {
            axes[0].side[e] = Measured{*end, kEndSigma_m};
        }
    }
    // A box's side lies at the outermost of handles and bulges; mirrors may be outside.
    for (const int e : {0, 1}) {
        const auto& line = e == 0 ? right_ : left_;
        if (!line) continue;
        const double gap = std::clamp(line->outermost_m - line->y_m, -kBulge_m, kBulge_m);
        axes[1].side[e] = Measured{line->y_m + gap, std::hypot(kSideSigma_m, kGapShare * gap)};
    }
    dropWeaker(axes[1]);
    if (ground_) axes[2].side[0] = Measured{*ground_, kGroundSigma_m};
    out_.rear = axes[0].side[0].has_value();
    out_.front = axes[0].side[1].has_value();
    out_.right = right_.has_value();
    out_.left = left_.has_value();
    out_.bottom = ground_.has_value();
    axes[1].middle = middleOfEnd();
    return axes;
}

/// The highest points within reach of where the top is expected.
std::optional<Measured> Fit::top(const Axis& z) const {
    if (!facing(2, 1)) return std::nullopt;
    const Measured expected = z.solve().side[1];
    Outermost top;
    for (const auto& p : points_) {
        if (p.z() < expected.value + 2 * expected.sigma) top.add(p.z());
    }
    if (top.value() < expected.value - 3 * expected.sigma) return std::nullopt;
    return Measured{top.value(), kTopSigma_m};
}

bool Fit::place() {
    auto axes = measure();
    axes[2].side[1] = top(axes[2]);
    out_.top = axes[2].side[1].has_value();
    Vec3 shift;
    for (int k = 0; k < 3; ++k) {
        const auto solved = holding(axes[k], k);
        shift[k] = solved.centre.value;
        sigma_[k] = solved.centre.sigma;
        size_[k] = solved.extent.value;
    }
    if (!shift.allFinite() || !(size_.minCoeff() > 0)) return false;
    T_obj_fit_ = T_obj_fit_ * SE3(geometry::Mat3::Identity(), shift);
    return true;
}

std::optional<BoxFit> Fit::run() {
    for (int round = 0; round < kRounds; ++round) {
        choosePoints();
        if (points_.size() < kLeastPoints) return std::nullopt;
        turn();
        choosePoints();
        if (points_.size() < kLeastPoints || !place()) return std::nullopt;
    }
    if (!(out_.rear || out_.front || out_.right || out_.left)) return std::nullopt;
    out_.T_obj_fitted = T_obj_fit_;
    out_.size_m = size_;
    out_.sigma_m = sigma_;
    out_.yawSigma_rad = yawSigma_;
    return out_;
}

}  // namespace

std::optional<BoxFit> fitBox(const BoxPoints& points, const BoxPrior& prior) {
    return Fit(points, prior).run();
}

}  // namespace djpete::backend
