/// Following patches from one image to the next.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "djpete/frontend/options.h"

namespace djpete::frontend {

/// An 8 bit grey image and its pyramid with gradients.
struct GreyPyramid {
    std::vector<cv::Mat> levels;  ///< as cv::buildOpticalFlowPyramid makes them
    cv::Mat grey;                 ///< level 0
    bool empty() const { return levels.empty(); }
};

GreyPyramid buildPyramid(const cv::Mat& grey, const FrontendOptions& options);

/// Where the patches about `from_px` went, starting at `guess_px` and using `levelsAboveFull`
/// pyramid levels. Nothing for a patch that leaves the image, loses its texture, or does not return
/// within options.kltForwardBackward_px when tracked back.
std::vector<std::optional<cv::Point2f>> followPatches(
    const GreyPyramid& from, const GreyPyramid& to, const std::vector<cv::Point2f>& from_px,
    const std::vector<cv::Point2f>& guess_px, int levelsAboveFull, const FrontendOptions& options);

}  // namespace djpete::frontend
