#include "dense_stereo.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace djpete::texture {

namespace {

constexpr int kBlock_px = 5;
constexpr int kMaxRange_px = 192;
constexpr int kTextureWindow_px = 5;

cv::Mat matched(const cv::Mat& left, const cv::Mat& right, int minDisparity, int range) {
    const auto matcher = cv::StereoSGBM::create(
        minDisparity, range, kBlock_px, 8 * kBlock_px * kBlock_px, 32 * kBlock_px * kBlock_px,
        /*disp12MaxDiff=*/1, /*preFilterCap=*/31, /*uniquenessRatio=*/10,
        /*speckleWindowSize=*/60, /*speckleRange=*/2);
    cv::Mat disparity16;
    matcher->compute(left, right, disparity16);
    return disparity16;
}

/// Mean horizontal contrast around each pixel: without any (sky) the matcher invents depth.
cv::Mat texture(const cv::Mat& grey) {
    cv::Mat contrast(grey.size(), CV_8UC1, cv::Scalar(0)), mean;
    const cv::Rect all(1, 0, grey.cols - 2, grey.rows);
    cv::absdiff(grey(all + cv::Point(1, 0)), grey(all - cv::Point(1, 0)), contrast(all));
    cv::boxFilter(contrast, mean, CV_32F, {kTextureWindow_px, kTextureWindow_px});
    return mean;
}

}  // namespace

cv::Mat denseDepth(const std::array<cv::Mat, 2>& greyPair, const geometry::StereoCamera& camera,
                   const PixelRect& rect, double minDepth_m, double maxDepth_m,
                   double minContrast) {
    cv::Mat depth(std::max(0, rect.y1 - rect.y0), std::max(0, rect.x1 - rect.x0), CV_32FC1,
                  cv::Scalar(0));
    if (rect.empty() || minDepth_m <= 0 || maxDepth_m <= minDepth_m) return depth;
    const double scale = camera.fx * camera.baseline_m;
    const int minDisparity = std::max(0, static_cast<int>(scale / maxDepth_m) - 1);
    const double needed = scale / minDepth_m + 2 - minDisparity;
    const int range = std::clamp(16 * static_cast<int>(std::ceil(needed / 16)), 16, kMaxRange_px);
    // Room to the left, where the right image shows the same things, and around for the windows.
    const int border = 2 * kBlock_px;
    const int x0 = std::max(0, rect.x0 - minDisparity - range - border);
    const int x1 = std::min(greyPair[0].cols, rect.x1 + border);
    const int y0 = std::max(0, rect.y0 - border), y1 = std::min(greyPair[0].rows, rect.y1 + border);
    if (x1 - x0 <= minDisparity + range + kBlock_px || y1 - y0 <= kBlock_px) return depth;
    const cv::Rect crop(x0, y0, x1 - x0, y1 - y0);
    const cv::Mat disparity16 = matched(greyPair[0](crop), greyPair[1](crop), minDisparity, range);
    const cv::Mat contrast = texture(greyPair[0](crop));
    const int lowest16 = std::max(1, 16 * minDisparity);
    for (int y = rect.y0; y < rect.y1; ++y) {
        const int16_t* from = disparity16.ptr<int16_t>(y - y0);
        float* to = depth.ptr<float>(y - rect.y0);
        for (int x = rect.x0; x < rect.x1; ++x) {
            const int d16 = from[x - x0];
            const bool textured =
                static_cast<double>(contrast.at<float>(y - y0, x - x0)) >= minContrast;
            if (d16 >= lowest16 && textured) to[x - rect.x0] = static_cast<float>(scale * 16 / d16);
        }
    }
    return depth;
}

}  // namespace djpete::texture
