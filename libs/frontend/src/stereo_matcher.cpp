#include "stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/intrin.hpp>

#include "patch_alignment.h"

namespace djpete::frontend {

namespace {

/// Rows of a rectified pair agree about so well (KITTI's are up to 0.3 px off), and few slopes
/// change disparity faster by row.
constexpr PlacePrior kPrior{0.5, 0.15};
constexpr double kMostRows_px = 1.5;
/// A best cost this much below the others' needs no search from right to left.
constexpr double kClear = 0.6;

// The search compares 16 columns (one register) by 2 * kHalf + 1 rows.
constexpr int kSearchLeft = 7, kSearchRight = 8;
constexpr int kSearchColumns = kSearchLeft + 1 + kSearchRight;

constexpr int kRowStep = 2;
constexpr int kSearchRows = (2 * kHalf) / kRowStep + 1;
constexpr int kSearchArea = kSearchColumns * kSearchRows;

/// The rows of a patch that the search compares.
using SearchPatch = std::array<cv::v_uint8x16, kSearchRows>;

SearchPatch searchPatch(const cv::Mat& image, int x, int y) {
    SearchPatch out;
    for (int r = 0; r < kSearchRows; ++r) {
        const uint8_t* row = image.ptr<uint8_t>(y - kHalf + r * kRowStep);
        out[static_cast<std::size_t>(r)] = cv::v_load(row + x - kSearchLeft);
    }
    return out;
}

/// Sum of |a - b - meanShift|, b + meanShift saturated to 8 bit.
int absoluteDifference(const SearchPatch& a, const cv::Mat& b, int xb, int y, int meanShift) {
    const cv::v_uint8x16 up = cv::v_setall_u8(static_cast<uint8_t>(std::clamp(meanShift, 0, 255)));
    const cv::v_uint8x16 down =
        cv::v_setall_u8(static_cast<uint8_t>(std::clamp(-meanShift, 0, 255)));
    const uint8_t* row = b.ptr<uint8_t>(y - kHalf) + xb - kSearchLeft;
    const std::size_t step = b.step[0] * kRowStep;
    // At most 6 * 255 in each of the two halves' 8 sums
    cv::v_uint16x8 sum = cv::v_setzero_u16();
    for (std::size_t r = 0; r < a.size(); ++r, row += step) {
        const cv::v_uint8x16 difference = cv::v_absdiff(a[r], (cv::v_load(row) + up) - down);
        cv::v_uint16x8 low, high;
        cv::v_expand(difference, low, high);
        sum += low + high;
    }
    return static_cast<int>(cv::v_reduce_sum(sum));
}

/// Sums over the rows that the search compares, of `count` columns from x on, rounded up to whole
/// registers; `sums` has room for 15 more.
void columnSums(const cv::Mat& image, int x, int count, int y, uint16_t* sums) {
    for (int c = 0; c < count; c += 16) {
        // Not beyond the image: the last register overlaps the one before.
        const int at = std::min(c, image.cols - 16 - x);
        cv::v_uint16x8 low = cv::v_setzero_u16(), high = low;
        for (int r = -kHalf; r <= kHalf; r += kRowStep) {
            cv::v_uint16x8 a, b;
            cv::v_expand(cv::v_load(image.ptr<uint8_t>(y + r) + x + at), a, b);
            low += a;
            high += b;
        }
        cv::v_store(sums + at, low);
        cv::v_store(sums + at + 8, high);
    }
}

int windowSum(const uint16_t* sums) {
    int sum = 0;
    for (int c = 0; c < kSearchColumns; ++c) sum += sums[c];
    return sum;
}

}  // namespace

StereoMatcher::StereoMatcher(const cv::Mat& left, const cv::Mat& right,
                             const geometry::StereoCamera& camera,
                             const StereoCalibration& calibration, const FrontendOptions& options)
    : left_(left),
      right_(right),
      camera_(camera),
      calibration_(calibration),
      options_(options),
      maxDisparity_px_(
          static_cast<int>(std::ceil(camera.fx * camera.baseline_m / options.stereoMinDepth_m))) {}

std::optional<StereoMatcher::SearchResult> StereoMatcher::search(const cv::Mat& from,
                                                                 const cv::Mat& to, int x, int row,
                                                                 int rowTo, int sign) const {
    const auto fits = [&](int column) {
        return column >= kSearchLeft && column < from.cols - kSearchRight;
    };
    // One disparity beyond zero, so that a point at infinity is a minimum too.
    const int first = -1;
    const int room = sign < 0 ? x - kSearchLeft : to.cols - 1 - kSearchRight - x;
    const int last = std::min(maxDisparity_px_, room);
    if (!fits(x) || !fits(x + sign * first) || last < first + 2 || std::min(row, rowTo) < kHalf ||
        std::max(row, rowTo) >= from.rows - kHalf)
        return std::nullopt;

    const int steps = last - first;
    // Windows of `to` go from column `lowest` on, rightwards; those of the search from either end.
    const int lowest = x - kSearchLeft + (sign > 0 ? first : -last);
    std::array<uint16_t, kSearchColumns + 16> fromSums;
    std::vector<uint16_t> toSums(static_cast<std::size_t>(steps + kSearchColumns + 16));
    columnSums(from, x - kSearchLeft, kSearchColumns, row, fromSums.data());
    columnSums(to, lowest, steps + kSearchColumns, rowTo, toSums.data());
    const int fromSum = windowSum(fromSums.data());
    int window = sign > 0 ? 0 : steps;
    int toSum = windowSum(toSums.data() + window);
    const SearchPatch patch = searchPatch(from, x, row);
    std::vector<int> cost;
    cost.reserve(static_cast<std::size_t>(steps + 1));
    for (int d = first; d <= last; ++d) {
        const int meanShift = (fromSum - toSum) / kSearchArea;
        cost.push_back(absoluteDifference(patch, to, x + sign * d, rowTo, meanShift));
        if (d == last) break;
        const int next = window + sign;
        const int enters = sign > 0 ? next + kSearchColumns - 1 : next;
        const int leaves = sign > 0 ? window : window + kSearchColumns - 1;
        toSum +=
            toSums[static_cast<std::size_t>(enters)] - toSums[static_cast<std::size_t>(leaves)];
        window = next;
    }
    const auto at = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    const auto costAt = [&](int i) { return cost[static_cast<std::size_t>(i)]; };
    int second = std::numeric_limits<int>::max();
    for (int i = 0; i < static_cast<int>(cost.size()); ++i) {
        if (std::abs(i - at) > 2) second = std::min(second, costAt(i));
    }
    if (costAt(at) > options_.stereoUniqueness * second) return std::nullopt;
    return SearchResult{first + at, costAt(at) / static_cast<double>(std::max(1, second))};
}

std::optional<StereoMatch> StereoMatcher::refined(const cv::Point2f& left_px, double disparity_px,
                                                  double maxShift_px) const {
    const double x = left_px.x, y = left_px.y;
    const auto forward = PatchTemplate::from(left_, x, y, kPrior);
    if (!forward) return std::nullopt;
    PatchPlace start;
    start.u_px = x - disparity_px;
    start.v_px = y + calibration_.rowAt(rayOf(left_px));
    const auto there = forward->align(right_, start, {maxShift_px, kMostRows_px});
    if (!there || there->correlation < options_.stereoMinCorrelation) return std::nullopt;
    const double disparity = x - there->u_px;
    if (disparity > maxDisparity_px_ || disparity < -1.0) return std::nullopt;
    const double sigma = std::hypot(options_.sigmaStereo_px, there->sigma_px);
    return StereoMatch{static_cast<float>(there->u_px), static_cast<float>(sigma),
                       static_cast<float>(-there->shear), static_cast<float>(there->v_px - y)};
}

bool StereoMatcher::matchesBack(const cv::Point2f& left_px, const StereoMatch& match) const {
    const double v = static_cast<double>(left_px.y) + match.rowDifference_px;
    const auto backward = PatchTemplate::from(right_, match.uRight_px, v, kPrior);
    if (!backward) return false;
    PatchPlace start;
    start.u_px = left_px.x;
    start.v_px = v - calibration_.rowAt(rayOf(left_px));
    start.shear = match.disparityPerRow;
    const auto back = backward->align(left_, start, {2.0, kMostRows_px});
    return back && std::abs(back->u_px - left_px.x) <= options_.stereoLeftRight_px;
}

std::optional<StereoMatch> StereoMatcher::rawMatch(const cv::Point2f& left_px,
                                                   std::optional<double> guess_px) const {
    if (guess_px) {
        const auto m = refined(left_px, *guess_px, 2.5);
        if (!m) return std::nullopt;
        const double d = static_cast<double>(left_px.x) - m->uRight_px;
        const bool foretold = std::abs(d - *guess_px) <= options_.stereoLeftRight_px;
        if (!foretold && !matchesBack(left_px, *m)) return std::nullopt;
        return m;
    }
    const int x = static_cast<int>(std::lround(left_px.x));
    const int row = static_cast<int>(std::lround(left_px.y));
    const int rowRight =
        static_cast<int>(std::lround(left_px.y + calibration_.rowAt(rayOf(left_px))));
    const auto d = search(left_, right_, x, row, rowRight, -1);
    if (!d) return std::nullopt;
    if (d->ambiguity > kClear) {
        const auto back = search(right_, left_, x - d->disparity_px, rowRight, row, +1);
        if (!back || std::abs(back->disparity_px - d->disparity_px) > 1) return std::nullopt;
    }
    const auto m = refined(left_px, d->disparity_px, 1.5);
    if (!m || !matchesBack(left_px, *m)) return std::nullopt;
    return m;
}

std::optional<StereoMatch> StereoMatcher::match(const cv::Point2f& left_px,
                                                std::optional<double> guess_px) const {
    const double offset_px = calibration_.disparity_px;
    if (guess_px) *guess_px += offset_px;
    auto m = rawMatch(left_px, guess_px);
    if (m) m->uRight_px += static_cast<float>(offset_px);
    return m;
}

}  // namespace djpete::frontend
