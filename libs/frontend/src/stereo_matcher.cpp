#include "stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace djpete::frontend {

namespace {

constexpr int kHalf = 5;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kArea = kSide * kSide;

using Patch = std::array<float, kArea>;

struct Refined {
    double shift_px = 0;  ///< column in the other image
    double shear = 0;     ///< columns per row
    double correlation = 0;
    double sigma_px = 0;  ///< from image noise alone
};

/// Bilinear samples along the rows y + [-kHalf, kHalf], columns x + shear * row + [..]; false if
/// any lies outside. `extra` more columns on both sides.
bool samplePatch(const cv::Mat& image, double x, double y, double shear, int extra, float* out) {
    const double reach = kHalf * std::abs(shear) + kHalf + extra;
    if (!(x - reach >= 0 && x + reach < image.cols - 1 && y - kHalf >= 0 &&
          y + kHalf < image.rows - 1)) {
        return false;
    }
    const int yFloor = static_cast<int>(std::floor(y));
    const auto fy = static_cast<float>(y - yFloor);
    const int width = kSide + 2 * extra;
    for (int r = 0; r < kSide; ++r) {
        const double xr = x + shear * (r - kHalf) - kHalf - extra;
        const int xFloor = static_cast<int>(std::floor(xr));
        const auto fx = static_cast<float>(xr - xFloor);
        const uint8_t* a = image.ptr<uint8_t>(yFloor + r - kHalf) + xFloor;
        const uint8_t* b = image.ptr<uint8_t>(yFloor + r - kHalf + 1) + xFloor;
        const float w00 = (1 - fx) * (1 - fy), w01 = fx * (1 - fy);
        const float w10 = (1 - fx) * fy, w11 = fx * fy;
        float* row = out + r * width;
        for (int c = 0; c < width; ++c) {
            row[c] = w00 * static_cast<float>(a[c]) + w01 * static_cast<float>(a[c + 1]) +
                     w10 * static_cast<float>(b[c]) + w11 * static_cast<float>(b[c + 1]);
        }
    }
    return true;
}

void removeMean(Patch& p) {
    float sum = 0;
    for (float v : p) sum += v;
    const float mean = sum / static_cast<float>(kArea);
    for (float& v : p) v -= mean;
}

float dot(const Patch& a, const Patch& b) {
    float sum = 0;
    for (int i = 0; i < kArea; ++i)
        sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(i)];
    return sum;
}

/// The patch of `from` at `px` and its derivatives by shift and by shear, means removed.
struct Template {
    Patch values, byShift, byShear;
};

std::optional<Template> makeTemplate(const cv::Mat& from, double x, double y) {
    std::array<float, kSide*(kSide + 2)> wide;
    if (!samplePatch(from, x, y, 0, 1, wide.data())) return std::nullopt;
    Template t;
    for (int r = 0; r < kSide; ++r) {
        for (int c = 0; c < kSide; ++c) {
            const auto i = static_cast<std::size_t>(r * kSide + c);
            const auto w = static_cast<std::size_t>(r * (kSide + 2) + c);
            t.values[i] = wide[w + 1];
            t.byShift[i] = 0.5F * (wide[w + 2] - wide[w]);
            t.byShear[i] = t.byShift[i] * static_cast<float>(r - kHalf);
        }
    }
    removeMean(t.values);
    removeMean(t.byShift);
    removeMean(t.byShear);
    return t;
}

/// Shift and shear that put the template at row y onto `to`, from column x0; at most
/// `maxShift_px` away from x0.
std::optional<Refined> align(const Template& t, const cv::Mat& to, double x0, double y,
                             double shear0, double maxShift_px) {
    // The shear is held near its start unless the patch says otherwise: prior of 0.15 columns per
    // row against noise of 3 grey levels.
    constexpr double kNoise = 3.0, kShearSigma = 0.15;
    const double prior = (kNoise / kShearSigma) * (kNoise / kShearSigma);
    const double a = dot(t.byShift, t.byShift), b = dot(t.byShift, t.byShear);
    const double c = static_cast<double>(dot(t.byShear, t.byShear)) + prior;
    const double det = a * c - b * b;
    if (!(a > 100.0) || !(det > 1e-6 * a * c)) return std::nullopt;

    Refined out;
    double x = x0, shear = shear0;
    Patch p;
    for (int i = 0; i < 15; ++i) {
        if (!samplePatch(to, x, y, shear, 0, p.data())) return std::nullopt;
        removeMean(p);
        Patch e;
        for (std::size_t k = 0; k < e.size(); ++k) e[k] = p[k] - t.values[k];
        const double g0 = dot(t.byShift, e);
        const double g1 = static_cast<double>(dot(t.byShear, e)) + prior * (shear - shear0);
        const double dx = (c * g0 - b * g1) / det, ds = (a * g1 - b * g0) / det;
        x -= dx;
        shear -= ds;
        if (std::abs(x - x0) > maxShift_px || std::abs(shear) > 1.0) return std::nullopt;
        if (std::abs(dx) < 0.005 && std::abs(ds) < 0.002) break;
    }
    if (!samplePatch(to, x, y, shear, 0, p.data())) return std::nullopt;
    removeMean(p);
    const double pp = dot(p, p), tt = dot(t.values, t.values);
    if (!(pp > 0) || !(tt > 0)) return std::nullopt;
    Patch e;
    for (std::size_t k = 0; k < e.size(); ++k) e[k] = p[k] - t.values[k];
    out.shift_px = x;
    out.shear = shear;
    out.correlation = dot(p, t.values) / std::sqrt(pp * tt);
    out.sigma_px = std::sqrt(dot(e, e) / kArea * c / det);
    return out;
}

/// Integer patch for the search.
int absoluteDifference(const cv::Mat& a, const cv::Mat& b, int xa, int xb, int y, int meanShift) {
    int sum = 0;
    for (int r = -kHalf; r <= kHalf; ++r) {
        const uint8_t* pa = a.ptr<uint8_t>(y + r) + xa - kHalf;
        const uint8_t* pb = b.ptr<uint8_t>(y + r) + xb - kHalf;
        for (int c = 0; c < kSide; ++c) sum += std::abs(pa[c] - pb[c] - meanShift);
    }
    return sum;
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
    if (x < kHalf || x >= from.cols - kHalf || y < kHalf || y >= from.rows - kHalf)
        return std::nullopt;
    // One disparity beyond zero, so that a point at infinity is a minimum too.
    const int first = -1;
    const int room = sign < 0 ? x - kHalf : to.cols - 1 - kHalf - x;
    const int last = std::min(maxDisparity_px_, room);
    if (last < first + 2) return std::nullopt;

    int fromSum = 0, toSum = 0;
    const int start = x + sign * first;
    if (start < kHalf || start >= to.cols - kHalf) return std::nullopt;
    for (int c = -kHalf; c <= kHalf; ++c) {
        fromSum += columnSum(from, x + c, y);
        toSum += columnSum(to, start + c, y);
    }
    std::vector<int> cost;
    cost.reserve(static_cast<std::size_t>(last - first + 1));
    for (int d = first; d <= last; ++d) {
        const int xt = x + sign * d;
        cost.push_back(absoluteDifference(from, to, x, xt, y, (fromSum - toSum) / kArea));
        if (d < last) {
            toSum +=
                columnSum(to, xt + sign * (kHalf + 1), y) - columnSum(to, xt - sign * kHalf, y);
        }
    }
    const auto best = std::min_element(cost.begin(), cost.end());
    const auto at = static_cast<int>(best - cost.begin());
    int second = std::numeric_limits<int>::max();
    for (int i = 0; i < static_cast<int>(cost.size()); ++i) {
        if (std::abs(i - at) > 2) second = std::min(second, cost[static_cast<std::size_t>(i)]);
    }
    if (*best > options_.stereoUniqueness * second) return std::nullopt;
    return first + at;
}

std::optional<StereoMatch> StereoMatcher::verified(const cv::Point2f& left_px, double disparity_px,
                                                   double maxShift_px) const {
    const double x = left_px.x, y = left_px.y;
    const auto forward = makeTemplate(left_, x, y);
    if (!forward) return std::nullopt;
    const auto there = align(*forward, right_, x - disparity_px, y, 0.0, maxShift_px);
    if (!there || there->correlation < options_.stereoMinCorrelation) return std::nullopt;
    const double disparity = x - there->shift_px;
    if (disparity > maxDisparity_px_ || disparity < -1.0) return std::nullopt;
    const auto backward = makeTemplate(right_, there->shift_px, y);
    if (!backward) return std::nullopt;
    const auto back = align(*backward, left_, x, y, -there->shear, 2.0);
    if (!back || std::abs(back->shift_px - x) > options_.stereoLeftRight_px) return std::nullopt;
    const double sigma = std::hypot(options_.sigmaStereo_px, there->sigma_px);
    return StereoMatch{static_cast<float>(there->shift_px), static_cast<float>(sigma)};
}

std::optional<StereoMatch> StereoMatcher::match(const cv::Point2f& left_px,
                                                std::optional<double> guess_px) const {
    if (guess_px) {
        if (const auto m = verified(left_px, *guess_px, 2.5)) return m;
    }
    const auto d = search(left_, right_, left_px, -1);
    if (!d) return std::nullopt;
    const cv::Point2f there(left_px.x - static_cast<float>(*d), left_px.y);
    const auto back = search(right_, left_, there, +1);
    if (!back || std::abs(*back - *d) > 1.5) return std::nullopt;
    return verified(left_px, *d, 1.5);
}

}  // namespace djpete::frontend
