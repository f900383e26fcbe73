#include "corners.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

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
    double xx = 0, xy = 0, yy = 0;
    for (int y = y0 - kHalf; y <= y0 + kHalf; ++y) {
        const uint8_t* above = grey.ptr<uint8_t>(y - 1);
        const uint8_t* row = grey.ptr<uint8_t>(y);
        const uint8_t* below = grey.ptr<uint8_t>(y + 1);
        for (int x = x0 - kHalf; x <= x0 + kHalf; ++x) {
            const double gx = 0.5 * (row[x + 1] - row[x - 1]);
            const double gy = 0.5 * (below[x] - above[x]);
            xx += gx * gx;
            xy += gx * gy;
            yy += gy * gy;
        }
    }
    const double n = (2 * kHalf + 1) * (2 * kHalf + 1);
    const double half = 0.5 * (xx - yy);
    return std::sqrt(std::max(0.0, 0.5 * (xx + yy) - std::sqrt(half * half + xy * xy)) / n);
}

/// The best of the few strongest FAST corners of a cell.
Candidate bestInCell(const cv::Mat& grey, const cv::Rect& cell, const cv::Mat& taken,
                     int threshold) {
    constexpr int kFastBorder = 3;  // FAST looks at a circle of radius 3
    cv::Rect wide(cell.x - kFastBorder, cell.y - kFastBorder, cell.width + 2 * kFastBorder,
                  cell.height + 2 * kFastBorder);
    wide &= cv::Rect(0, 0, grey.cols, grey.rows);
    std::vector<cv::KeyPoint> found;
    cv::FAST(grey(wide), found, threshold, true);
    std::sort(found.begin(), found.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
        if (a.response != b.response) return a.response > b.response;
        return a.pt.y != b.pt.y ? a.pt.y < b.pt.y : a.pt.x < b.pt.x;
    });
    Candidate best;
    int looked = 0;
    for (const auto& k : found) {
        const cv::Point2f px(k.pt.x + static_cast<float>(wide.x),
                             k.pt.y + static_cast<float>(wide.y));
        if (taken.at<uint8_t>(cv::Point(px)) != 0) continue;
        const double texture = textureAt(grey, px);
        if (texture > best.texture) best = {px, texture};
        if (++looked == 4) break;
    }
    return best;
}

/// Where no corner may be found: excluded, or near a feature.
cv::Mat takenMask(const cv::Size& size, const std::vector<cv::Point2f>& existing,
                  const cv::Mat& exclusion, double distance_px) {
    cv::Mat taken = exclusion.empty() ? cv::Mat::zeros(size, CV_8U) : exclusion.clone();
    const int r = static_cast<int>(std::floor(distance_px));
    for (const auto& p : existing) {
        const cv::Rect box(static_cast<int>(std::lround(p.x)) - r,
                           static_cast<int>(std::lround(p.y)) - r, 2 * r + 1, 2 * r + 1);
        taken(box & cv::Rect(0, 0, size.width, size.height)).setTo(255);
    }
    return taken;
}

}  // namespace

std::vector<cv::Point2f> detectCorners(const cv::Mat& grey,
                                       const std::vector<cv::Point2f>& existing,
                                       const cv::Mat& exclusion, int wanted,
                                       const FrontendOptions& options) {
    std::vector<cv::Point2f> out;
    const int border = options.border_px;
    const int width = grey.cols - 2 * border, height = grey.rows - 2 * border;
    if (wanted <= 0 || width < 8 || height < 8) return out;
    // Twice as many cells as features: many cells (sky, road) hold none.
    const double side =
        std::max(options.minDistance_px, std::sqrt(0.5 * width * height / options.featuresWanted));
    const int columns = std::max(1, static_cast<int>(width / side));
    const int rows = std::max(1, static_cast<int>(height / side));

    const auto columnOf = [&](double x) {
        return std::clamp(static_cast<int>((x - border) * columns / width), 0, columns - 1);
    };
    const auto rowOf = [&](double y) {
        return std::clamp(static_cast<int>((y - border) * rows / height), 0, rows - 1);
    };
    std::vector<bool> full(static_cast<std::size_t>(columns * rows), false);
    for (const auto& p : existing) {
        full[static_cast<std::size_t>(rowOf(p.y) * columns + columnOf(p.x))] = true;
    }

    cv::Mat taken = takenMask(grey.size(), existing, exclusion, options.minDistance_px);
    std::vector<Candidate> candidates;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            if (full[static_cast<std::size_t>(r * columns + c)]) continue;
            const int x0 = border + c * width / columns, x1 = border + (c + 1) * width / columns;
            const int y0 = border + r * height / rows, y1 = border + (r + 1) * height / rows;
            const cv::Rect cell(x0, y0, x1 - x0, y1 - y0);
            Candidate best = bestInCell(grey, cell, taken, options.fastThreshold);
            if (best.texture < options.minTexture &&
                options.fastThresholdLow < options.fastThreshold)
                best = bestInCell(grey, cell, taken, options.fastThresholdLow);
            if (best.texture < options.minTexture) continue;
            candidates.push_back(best);
            const int d = static_cast<int>(std::floor(options.minDistance_px));
            const cv::Rect box(static_cast<int>(best.px.x) - d, static_cast<int>(best.px.y) - d,
                               2 * d + 1, 2 * d + 1);
            taken(box & cv::Rect(0, 0, grey.cols, grey.rows)).setTo(255);
        }
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
