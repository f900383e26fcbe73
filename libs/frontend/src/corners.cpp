#include "corners.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

#include "mark_taken.h"

namespace djpete::frontend {

namespace {

struct Candidate {
    cv::Point2f px;
    double texture = 0;
};

/// Root of the smaller eigenvalue of the mean structure tensor over 9x9 pixels: how many grey
/// levels a shift by one pixel changes at least.
double textureAt(const cv::Mat& grey, const cv::Point2f& px) {
    constexpr int kHalf = 4;
    const int x0 = static_cast<int>(px.x), y0 = static_cast<int>(px.y);
    int sumXX = 0, sumXY = 0, sumYY = 0;  // of doubled gradients
    for (int y = y0 - kHalf; y <= y0 + kHalf; ++y) {
        const uint8_t* above = grey.ptr<uint8_t>(y - 1) + x0 - kHalf;
        const uint8_t* row = grey.ptr<uint8_t>(y) + x0 - kHalf;
        const uint8_t* below = grey.ptr<uint8_t>(y + 1) + x0 - kHalf;
        for (int c = 0; c <= 2 * kHalf; ++c) {
            const int gx = row[c + 1] - row[c - 1], gy = below[c] - above[c];
            sumXX += gx * gx;
            sumXY += gx * gy;
            sumYY += gy * gy;
        }
    }
    const double xx = 0.25 * sumXX, xy = 0.25 * sumXY, yy = 0.25 * sumYY;
    const double n = (2 * kHalf + 1) * (2 * kHalf + 1);
    const double half = 0.5 * (xx - yy);
    return std::sqrt(std::max(0.0, 0.5 * (xx + yy) - std::sqrt(half * half + xy * xy)) / n);
}

/// Where no corner may be found: excluded, or near a feature.
cv::Mat takenMask(const cv::Size& size, const std::vector<cv::Point2f>& existing,
                  const cv::Mat& exclusion, double distance_px) {
    cv::Mat taken = exclusion.empty() ? cv::Mat::zeros(size, CV_8U) : exclusion.clone();
    const int r = static_cast<int>(std::floor(distance_px));
    for (const auto& p : existing) {
        markTaken(taken, static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)), r);
    }
    return taken;
}

/// Image cells of about one wanted feature each.
class Grid {
  public:
    Grid(const cv::Size& size, const FrontendOptions& options)
        : border_(options.border_px),
          width_(size.width - 2 * options.border_px),
          height_(size.height - 2 * options.border_px) {
        // Twice as many cells as features: many cells (sky, road) hold none.
        const double side = std::max(options.minDistance_px,
                                     std::sqrt(0.5 * width_ * height_ / options.featuresWanted));
        columns_ = std::max(1, static_cast<int>(width_ / side));
        rows_ = std::max(1, static_cast<int>(height_ / side));
    }
    std::size_t cells() const { return static_cast<std::size_t>(columns_ * rows_); }
    std::size_t cellOf(const cv::Point2f& p) const {
        const int c = (static_cast<int>(p.x) - border_) * columns_ / width_;
        const int r = (static_cast<int>(p.y) - border_) * rows_ / height_;
        return static_cast<std::size_t>(std::clamp(r, 0, rows_ - 1) * columns_ +
                                        std::clamp(c, 0, columns_ - 1));
    }

  private:
    int border_, width_, height_, columns_ = 1, rows_ = 1;
};

/// Stronger first; ties in reading order.
bool stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.pt.y != b.pt.y ? a.pt.y < b.pt.y : a.pt.x < b.pt.x;
}

/// FAST corners within the border, by cell.
std::vector<std::vector<cv::KeyPoint>> fastByCell(const cv::Mat& grey, const Grid& grid,
                                                  const std::vector<bool>& full,
                                                  const FrontendOptions& options) {
    constexpr int kFastBorder = 3;  // FAST looks at a circle of radius 3
    const int inset = options.border_px - kFastBorder;
    const cv::Rect inner(inset, inset, grey.cols - 2 * inset, grey.rows - 2 * inset);
    std::vector<cv::KeyPoint> found;
    cv::FAST(grey(inner), found, options.fastThreshold, true);
    std::vector<std::vector<cv::KeyPoint>> out(grid.cells());
    for (auto& k : found) {
        k.pt += cv::Point2f(static_cast<float>(inset), static_cast<float>(inset));
        const std::size_t cell = grid.cellOf(k.pt);
        if (!full[cell]) out[cell].push_back(k);
    }
    return out;
}

/// The most textured of a cell's few strongest corners where nothing is taken.
Candidate bestOf(std::vector<cv::KeyPoint>& corners, const cv::Mat& grey, const cv::Mat& taken) {
    std::sort(corners.begin(), corners.end(), stronger);
    Candidate best;
    int looked = 0;
    for (const auto& k : corners) {
        if (taken.at<uint8_t>(cv::Point(k.pt)) != 0) continue;
        const double texture = textureAt(grey, k.pt);
        if (texture > best.texture) best = {k.pt, texture};
        if (++looked == 4) break;
    }
    return best;
}

}  // namespace

std::vector<cv::Point2f> detectCorners(const cv::Mat& grey,
                                       const std::vector<cv::Point2f>& existing,
                                       const cv::Mat& exclusion, int wanted,
                                       const FrontendOptions& options) {
    std::vector<cv::Point2f> out;
    if (wanted <= 0 || std::min(grey.cols, grey.rows) < 2 * options.border_px + 8) return out;
    const Grid grid(grey.size(), options);
    std::vector<bool> full(grid.cells(), false);
    for (const auto& p : existing) full[grid.cellOf(p)] = true;

    cv::Mat taken = takenMask(grey.size(), existing, exclusion, options.minDistance_px);
    std::vector<Candidate> candidates;
    for (auto& corners : fastByCell(grey, grid, full, options)) {
        const Candidate best = bestOf(corners, grey, taken);
        if (best.texture < options.minTexture) continue;
        candidates.push_back(best);
        const int d = static_cast<int>(std::floor(options.minDistance_px));
        markTaken(taken, static_cast<int>(best.px.x), static_cast<int>(best.px.y), d);
    }
    if (candidates.size() > static_cast<std::size_t>(wanted)) {
        std::stable_sort(
            candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.texture > b.texture; });
        candidates.resize(static_cast<std::size_t>(wanted));
    }
    out.reserve(candidates.size());
    for (const auto& c : candidates) out.push_back(c.px);
    return out;
}

}  // namespace djpete::frontend
