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

constexpr double kBeside_m = 0.3;        // points so far outside the box may belong to it
constexpr double kClearance_m = 0.12;    // over the ground
constexpr double kFacing_m = 0.3;        // a scanner this far before a side sees it
constexpr std::size_t kLeastPoints = 20;
constexpr double kEndSigma_m = 0.025, kSideSigma_m = 0.015, kGroundSigma_m = 0.03,
                 kTopSigma_m = 0.03, kHoldSigma_m = 0.02;
constexpr int kRounds = 3;

/// One axis of the box: its centre and extent, from a prior and what is known of both sides.
struct Axis {
    Measured centre, extent;
    std::optional<Measured> low, high;     // sides that were seen
    std::optional<double> atMost, atLeast;  // the low side is at most here, the high at least

    void solve();
};

void Axis::solve() {
    const Measured c0 = centre, e0 = extent;
    bool holdLow = false, holdHigh = false;
    for (int round = 0; round < 3; ++round) {
        geometry::Mat2 A = geometry::Mat2::Zero();
        geometry::Vec2 b = geometry::Vec2::Zero();
        const auto add = [&](double dc, double de, const Measured& m) {
            const geometry::Vec2 j(dc, de);
            A += j * j.transpose() / (m.sigma * m.sigma);
            b += j * m.value / (m.sigma * m.sigma);
        };
        add(1, 0, c0);
        add(0, 1, e0);
        if (low) add(1, -0.5, *low);
        if (high) add(1, 0.5, *high);
        if (holdLow) add(1, -0.5, {*atMost, kHoldSigma_m});
        if (holdHigh) add(1, 0.5, {*atLeast, kHoldSigma_m});
        const geometry::Mat2 C = A.inverse();
        const geometry::Vec2 x = C * b;
        centre = {x[0], std::sqrt(C(0, 0))};
        extent = {x[1], std::sqrt(C(1, 1))};
        holdLow = holdLow || (!low && atMost && x[0] - 0.5 * x[1] > *atMost);
        holdHigh = holdHigh || (!high && atLeast && x[0] + 0.5 * x[1] < *atLeast);
    }
}

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
    bool facing(int axis, int sign) const;
    /// Outermost point towards a side, as a coordinate.
    double reach(int axis, int sign) const;
    void groundAndTop(Axis& z);

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
        return sign * p[axis] > 0.5 * size_[axis] + kFacing_m;
    });
}

double Fit::reach(int axis, int sign) const {
    std::vector<double> values;
    values.reserve(points_.size());
    for (const auto& p : points_) values.push_back(sign * p[axis]);
    return sign * outermost(std::move(values));
}

void Fit::turn() {
    const double search = std::clamp(3 * yawSigma_, 0.02, 0.25);
    right_.reset();
    left_.reset();
    if (facing(1, -1)) right_ = fitSide(points_, -1, size_.y(), search);
    if (facing(1, 1)) left_ = fitSide(points_, 1, size_.y(), search);
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

void Fit::groundAndTop(Axis& z) {
    if (ground_) {
        z.low = Measured{*ground_, kGroundSigma_m};
        out_.bottom = true;
    }
    const double top = reach(2, 1);
    if (facing(2, 1)) {
        z.high = Measured{top, kTopSigma_m};
        out_.top = true;
    } else {
        z.atLeast = top;
    }
}

bool Fit::place() {
    const Vec3 p_prior = T_obj_fit_.inverse() * Vec3::Zero();
    std::array<Axis, 3> axes;
    for (int k = 0; k < 3; ++k) {
        axes[k].centre = {p_prior[k], prior_.sigma_m[k]};
        axes[k].extent = {prior_.size_m[k], prior_.sizeSigma_m[k]};
        if (k == 2) break;
        axes[k].atMost = reach(k, -1);
        axes[k].atLeast = reach(k, 1);
    }
    out_ = BoxFit();
    if (facing(0, -1)) {
        if (const auto end = fitEnd(points_, -1, size_)) axes[0].low = Measured{*end, kEndSigma_m};
    }
    if (facing(0, 1)) {
        if (const auto end = fitEnd(points_, 1, size_)) axes[0].high = Measured{*end, kEndSigma_m};
    }
    out_.rear = axes[0].low.has_value();
    out_.front = axes[0].high.has_value();
    // The box's side lies between the panels and the outermost mirror.
    const auto side = [](const SideLine& line) {
        const double gap = std::abs(line.outermost_m - line.y_m);
        return Measured{0.5 * (line.outermost_m + line.y_m),
                        std::hypot(kSideSigma_m, gap / std::sqrt(12.0))};
    };
    if (right_) axes[1].low = side(*right_);
    if (left_) axes[1].high = side(*left_);
    out_.right = right_.has_value();
    out_.left = left_.has_value();
    groundAndTop(axes[2]);
    Vec3 shift;
    for (int k = 0; k < 3; ++k) {
        axes[k].solve();
        shift[k] = axes[k].centre.value;
        sigma_[k] = axes[k].centre.sigma;
        size_[k] = axes[k].extent.value;
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
