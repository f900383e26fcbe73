#include "stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/intrin.hpp>

namespace djpete::frontend {

namespace {

constexpr int kHalf = 5;
constexpr std::size_t kSide = 2 * kHalf + 1;
constexpr std::size_t kArea = kSide * kSide;

/// Row by row; the padding beyond kArea stays zero, so that sums may run over whole registers.
using Patch = Eigen::Matrix<float, 128, 1>;

struct Refined {
    double u_px = 0, v_px = 0;  ///< in the other image
    double shear = 0;           ///< columns per row
    double correlation = 0;
    double sigma_px = 0;  ///< of u, from the patches' difference alone
};

/// Bilinear samples about (x, y): rows y + [-half, half], half = kHalf + extra, row r moved by
/// shear * r columns; false if any lies outside.
bool samplePatch(const cv::Mat& image, double x, double y, double shear, int extra, float* out) {
    const int half = kHalf + extra, side = 2 * half + 1;
    const double reach = half * std::abs(shear) + half;
    if (!(x - reach >= 0 && x + reach < image.cols - 1 && y - half >= 0 &&
          y + half < image.rows - 1)) {
        return false;
    }
    const int yFloor = static_cast<int>(std::floor(y));
    const auto fy = static_cast<float>(y - yFloor);
    for (int r = 0; r < side; ++r) {
        const double xr = x + shear * (r - half) - half;
        const int xFloor = static_cast<int>(std::floor(xr));
        const auto fx = static_cast<float>(xr - xFloor);
        const uint8_t* a = image.ptr<uint8_t>(yFloor + r - half) + xFloor;
        const uint8_t* b = image.ptr<uint8_t>(yFloor + r - half + 1) + xFloor;
        const float w00 = (1 - fx) * (1 - fy), w01 = fx * (1 - fy);
        const float w10 = (1 - fx) * fy, w11 = fx * fy;
        float* row = out + r * side;
        for (int c = 0; c < side; ++c) {
            row[c] = w00 * static_cast<float>(a[c]) + w01 * static_cast<float>(a[c + 1]) +
                     w10 * static_cast<float>(b[c]) + w11 * static_cast<float>(b[c + 1]);
        }
    }
    return true;
}

void removeMean(Patch& p) {
    auto values = p.head<static_cast<int>(kArea)>().array();
    values -= p.sum() / static_cast<float>(kArea);
}

double dot(const Patch& a, const Patch& b) { return a.dot(b); }

/// The patch of `from` about a pixel and its derivatives by column, row and shear, means removed,
/// with the inverse of the normal matrix of an alignment to it.
struct Template {
    Patch values;
    std::array<Patch, 3> by;
    geometry::Mat3 prior = geometry::Mat3::Zero();
    geometry::Mat3 inverse;
};

/// What alignment believes before it looks: rectified rows agree within kRowSigma_px, slopes are
/// within kShearSigma columns per row, and grey values differ by kNoise levels.
constexpr double kNoise = 3.0, kRowSigma_px = 0.5, kShearSigma = 0.15;

std::optional<Template> makeTemplate(const cv::Mat& from, double x, double y) {
    constexpr std::size_t kWide = kSide + 2;
    std::array<float, kWide * kWide> wide;
    if (!samplePatch(from, x, y, 0, 1, wide.data())) return std::nullopt;
    Template t;
    t.values.setZero();
    for (auto& p : t.by) p.setZero();
    for (std::size_t r = 0; r < kSide; ++r) {
        for (std::size_t c = 0; c < kSide; ++c) {
            const std::size_t w = (r + 1) * kWide + c + 1;
            const auto i = static_cast<Eigen::Index>(r * kSide + c);
            t.values[i] = wide[w];
            t.by[0][i] = 0.5F * (wide[w + 1] - wide[w - 1]);
            t.by[1][i] = 0.5F * (wide[w + kWide] - wide[w - kWide]);
            t.by[2][i] = t.by[0][i] * (static_cast<float>(r) - static_cast<float>(kHalf));
        }
    }
    removeMean(t.values);
    for (auto& p : t.by) removeMean(p);
    t.prior(1, 1) = (kNoise / kRowSigma_px) * (kNoise / kRowSigma_px);
    t.prior(2, 2) = (kNoise / kShearSigma) * (kNoise / kShearSigma);
    geometry::Mat3 H = t.prior;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            H(i, j) += dot(t.by[static_cast<std::size_t>(i)], t.by[static_cast<std::size_t>(j)]);
        }
    }
    if (!(H(0, 0) > 100.0)) return std::nullopt;
    t.inverse = H.inverse();
    if (!t.inverse.allFinite()) return std::nullopt;
    return t;
}

/// Where and how sheared the template lies in `to`, from (u, v) with `shear` in `start`; the
/// column at most `maxShift_px` away from there.
std::optional<Refined> align(const Template& t, const cv::Mat& to, const Refined& start,
                             double maxShift_px) {
    Refined out = start;
    Patch p = Patch::Zero(), e;
    const auto compare = [&] {
        if (!samplePatch(to, out.u_px, out.v_px, out.shear, 0, p.data())) return false;
        removeMean(p);
        e = p - t.values;
        return true;
    };
    for (int i = 0; i < 12; ++i) {
        if (!compare()) return std::nullopt;
        const geometry::Vec3 moved(0, out.v_px - start.v_px, out.shear - start.shear);
        const geometry::Vec3 gradient =
            geometry::Vec3(dot(t.by[0], e), dot(t.by[1], e), dot(t.by[2], e)) + t.prior * moved;
        const geometry::Vec3 step = t.inverse * gradient;
        out.u_px -= step.x();
        out.v_px -= step.y();
        out.shear -= step.z();
        if (std::abs(out.u_px - start.u_px) > maxShift_px ||
            std::abs(out.v_px - start.v_px) > 1.5 || std::abs(out.shear) > 1.0)
            return std::nullopt;
        if (step.cwiseAbs().maxCoeff() < 0.005) break;
    }
    if (!compare()) return std::nullopt;
    const double pp = dot(p, p), tt = dot(t.values, t.values);
    if (!(pp > 0) || !(tt > 0)) return std::nullopt;
    out.correlation = dot(p, t.values) / std::sqrt(pp * tt);
    out.sigma_px = std::sqrt(dot(e, e) / kArea * t.inverse(0, 0));
    return out;
}

// The search compares 16 columns (one register) by 2 * kHalf + 1 rows.
constexpr int kSearchLeft = 7, kSearchRight = 8;
constexpr int kSearchArea = (kSearchLeft + 1 + kSearchRight) * (2 * kHalf + 1);

/// Sum of |a - b - meanShift|, b + meanShift saturated to 8 bit.
int absoluteDifference(const cv::Mat& a, const cv::Mat& b, int xa, int xb, int y, int meanShift) {
    const cv::v_uint8x16 up = cv::v_setall_u8(static_cast<uint8_t>(std::clamp(meanShift, 0, 255)));
    const cv::v_uint8x16 down =
        cv::v_setall_u8(static_cast<uint8_t>(std::clamp(-meanShift, 0, 255)));
    unsigned sum = 0;
    for (int r = -kHalf; r <= kHalf; ++r) {
        const cv::v_uint8x16 pa = cv::v_load(a.ptr<uint8_t>(y + r) + xa - kSearchLeft);
        const cv::v_uint8x16 pb = cv::v_load(b.ptr<uint8_t>(y + r) + xb - kSearchLeft);
        sum += cv::v_reduce_sad(pa, (pb + up) - down);
    }
    return static_cast<int>(sum);
}

int columnSum(const cv::Mat& image, int x, int y) {
    int sum = 0;
    for (int r = -kHalf; r <= kHalf; ++r) sum += image.ptr<uint8_t>(y + r)[x];
    return sum;
}

}  // namespace

StereoMatcher::StereoMatcher(const cv::Mat& left, const cv::Mat& right,
                             const geometry::StereoCamera& camera, const FrontendOptions& options)
    : left_(left),
      right_(right),
      options_(options),
      maxDisparity_px_(
          static_cast<int>(std::ceil(camera.fx * camera.baseline_m / options.stereoMinDepth_m))) {}

std::optional<double> StereoMatcher::search(const cv::Mat& from, const cv::Mat& to,
                                            const cv::Point2f& px, int sign) const {
    const int x = static_cast<int>(std::lround(px.x)), y = static_cast<int>(std::lround(px.y));
    const auto fits = [&](int column) {
        return column >= kSearchLeft && column < from.cols - kSearchRight;
    };
    // One disparity beyond zero, so that a point at infinity is a minimum too.
    const int first = -1;
    const int room = sign < 0 ? x - kSearchLeft : to.cols - 1 - kSearchRight - x;
    const int last = std::min(maxDisparity_px_, room);
    if (!fits(x) || !fits(x + sign * first) || y < kHalf || y >= from.rows - kHalf ||
        last < first + 2)
        return std::nullopt;

    int fromSum = 0, toSum = 0;
    for (int c = -kSearchLeft; c <= kSearchRight; ++c) {
        fromSum += columnSum(from, x + c, y);
        toSum += columnSum(to, x + sign * first + c, y);
    }
    std::vector<int> cost;
    cost.reserve(static_cast<std::size_t>(last - first + 1));
    for (int d = first; d <= last; ++d) {
        const int xt = x + sign * d;
        cost.push_back(absoluteDifference(from, to, x, xt, y, (fromSum - toSum) / kSearchArea));
        if (d == last) break;
        const int enters = sign > 0 ? xt + kSearchRight + 1 : xt - kSearchLeft - 1;
        const int leaves = sign > 0 ? xt - kSearchLeft : xt + kSearchRight;
        toSum += columnSum(to, enters, y) - columnSum(to, leaves, y);
    }
    const auto at = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    const auto costAt = [&](int i) { return cost[static_cast<std::size_t>(i)]; };
    int second = std::numeric_limits<int>::max();
    for (int i = 0; i < static_cast<int>(cost.size()); ++i) {
        if (std::abs(i - at) > 2) second = std::min(second, costAt(i));
    }
    if (costAt(at) > options_.stereoUniqueness * second) return std::nullopt;
    return first + at;
}

std::optional<StereoMatch> StereoMatcher::verified(const cv::Point2f& left_px, double disparity_px,
                                                   double maxShift_px) const {
    const double x = left_px.x, y = left_px.y;
    const auto forward = makeTemplate(left_, x, y);
    if (!forward) return std::nullopt;
    Refined start;
    start.u_px = x - disparity_px;
    start.v_px = y;
    const auto there = align(*forward, right_, start, maxShift_px);
    if (!there || there->correlation < options_.stereoMinCorrelation) return std::nullopt;
    const double disparity = x - there->u_px;
    if (disparity > maxDisparity_px_ || disparity < -1.0) return std::nullopt;
    const auto backward = makeTemplate(right_, there->u_px, there->v_px);
    if (!backward) return std::nullopt;
    start.u_px = x;
    start.v_px = y;
    start.shear = -there->shear;
    const auto back = align(*backward, left_, start, 2.0);
    if (!back || std::abs(back->u_px - x) > options_.stereoLeftRight_px) return std::nullopt;
    const double sigma = std::hypot(options_.sigmaStereo_px, there->sigma_px);
    return StereoMatch{static_cast<float>(there->u_px), static_cast<float>(sigma)};
}

std::optional<StereoMatch> StereoMatcher::match(const cv::Point2f& left_px,
                                                std::optional<double> guess_px) const {
    if (guess_px) return verified(left_px, *guess_px, 2.5);
    const auto d = search(left_, right_, left_px, -1);
    if (!d) return std::nullopt;
    const cv::Point2f there(left_px.x - static_cast<float>(*d), left_px.y);
    const auto back = search(right_, left_, there, +1);
    if (!back || std::abs(*back - *d) > 1.5) return std::nullopt;
    return verified(left_px, *d, 1.5);
}

}  // namespace djpete::frontend
