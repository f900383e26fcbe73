#include "patch_alignment.h"

#include <cmath>

#include "patch_sampling.h"

namespace djpete::frontend {

namespace {

constexpr double kNoise = 3.0;             // grey levels between two views of a patch
constexpr double kLeastCurvature = 100.0;  // grey levels squared per px squared, of the whole patch
constexpr float kArea = kSide * kSide;

double precision(double sigma) { return (kNoise / sigma) * (kNoise / sigma); }

/// Removes the mean and clears the last column.
void centre(Patch& p) {
    const float mean = sumAndSquare(p).sum / kArea;
    for (float& v : p.values) v -= mean;
    for (int r = 0; r < kSide; ++r) p.values[static_cast<std::size_t>(r * kStride + kSide)] = 0;
}

/// Both directions of the plane move the patch, and the matrix can be inverted.
bool wellTextured(const geometry::Mat3& H) {
    const double half = 0.5 * (H(0, 0) - H(1, 1));
    const double least = 0.5 * (H(0, 0) + H(1, 1)) - std::sqrt(half * half + H(0, 1) * H(0, 1));
    return H(0, 0) > kLeastCurvature && least > kLeastCurvature;
}

}  // namespace

std::optional<PatchTemplate> PatchTemplate::fromWide(const float* wide, int wideStride,
                                                     const PlacePrior& prior) {
    std::optional<PatchTemplate> out(std::in_place);
    PatchTemplate& t = *out;
    for (int r = 0; r < kSide; ++r) {
        const float* above = wide + r * wideStride + 1;
        const float* row = above + wideStride;
        const float* below = row + wideStride;
        const auto down = static_cast<float>(r - kHalf);
        float* value = t.values_.values.data() + r * kStride;
        float* byColumn = t.by_[0].values.data() + r * kStride;
        float* byRow = t.by_[1].values.data() + r * kStride;
        float* byShear = t.by_[2].values.data() + r * kStride;
        for (int c = 0; c < kStride; ++c) {  // the last column is cleared below
            value[c] = row[c];
            byColumn[c] = 0.5F * (row[c + 1] - row[c - 1]);
            byRow[c] = 0.5F * (below[c] - above[c]);
            byShear[c] = byColumn[c] * down;
        }
    }
    t.sheared_ = prior.shear > 0;
    const std::size_t unknowns = t.sheared_ ? 3 : 2;
    centre(t.values_);
    for (std::size_t i = 0; i < unknowns; ++i) centre(t.by_[i]);
    const double shear = t.sheared_ ? precision(prior.shear) : 1.0;
    t.prior_ = geometry::Vec3(0, precision(prior.row_px), shear).asDiagonal();
    geometry::Mat3 H = t.prior_;
    for (std::size_t i = 0; i < unknowns; ++i) {
        t.valuesBy_[i] = dot(t.values_, t.by_[i]);
        for (std::size_t j = 0; j <= i; ++j) {
            const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
            H(a, b) += dot(t.by_[i], t.by_[j]);
            H(b, a) = H(a, b);
        }
    }
    t.square_ = dot(t.values_, t.values_);
    if (!wellTextured(H) || !(t.square_ > 0)) return std::nullopt;
    t.inverse_ = H.inverse();
    if (!t.inverse_.allFinite()) out.reset();
    return out;
}

std::optional<PatchTemplate> PatchTemplate::from(const cv::Mat& grey, double u_px, double v_px,
                                                 const PlacePrior& prior) {
    WidePatch wide;
    if (!sampleWide(grey, u_px, v_px, wide)) return std::nullopt;
    return fromWide(wide.values.data(), WidePatch::kStride, prior);
}

std::optional<PatchTemplate> PatchTemplate::warped(const cv::Mat& grey, double u_px, double v_px,
                                                   const geometry::Mat2& stepsPerPixel,
                                                   const PlacePrior& prior) {
    WidePatch wide;
    if (!sampleWarped(grey, u_px, v_px, stepsPerPixel, wide)) return std::nullopt;
    return fromWide(wide.values.data(), WidePatch::kStride, prior);
}

std::optional<PatchPlace> PatchTemplate::align(const cv::Mat& grey, const PatchPlace& start,
                                               const SearchReach& reach) const {
    constexpr int kMostSteps = 12;
    constexpr double kSmallStep = 0.01;  // px, and px at the patch's rim by shear
    PatchPlace out = start;
    Patch p;
    for (int i = 0; i < kMostSteps; ++i) {
        const bool inside = sheared_ ? sampleSheared(grey, out.u_px, out.v_px, out.shear, p)
                                     : sampleUpright(grey, out.u_px, out.v_px, p);
        if (!inside) return std::nullopt;
        geometry::Vec3 gradient(dot(p, by_[0]) - valuesBy_[0], dot(p, by_[1]) - valuesBy_[1], 0);
        gradient.y() += prior_(1, 1) * (out.v_px - start.v_px);
        if (sheared_) {
            gradient.z() = dot(p, by_[2]) - valuesBy_[2];
            gradient.z() += prior_(2, 2) * (out.shear - start.shear);
        }
        const geometry::Vec3 step = inverse_ * gradient;
        out.u_px -= step.x();
        out.v_px -= step.y();
        if (sheared_) out.shear -= step.z();
        if (!(std::abs(out.u_px - start.u_px) <= reach.u_px) ||
            !(std::abs(out.v_px - start.v_px) <= reach.v_px) || std::abs(out.shear) > 1.0)
            return std::nullopt;
        const double rim = sheared_ ? kHalf * std::abs(step.z()) : 0;
        if (std::max({std::abs(step.x()), std::abs(step.y()), rim}) < kSmallStep) break;
    }
    // The last samples are a hundredth of a pixel beside the result: near enough to judge it.
    const auto sums = sumAndSquare(p);
    const double pp = sums.square - sums.sum * sums.sum / kArea;
    if (!(pp > 0)) return std::nullopt;
    const double pt = dot(p, values_);
    out.correlation = pt / std::sqrt(pp * square_);
    const double ee = std::max(0.0, pp + square_ - 2 * pt);
    out.sigma_px = std::sqrt(ee / kArea * inverse_(0, 0));
    return out;
}

}  // namespace djpete::frontend
