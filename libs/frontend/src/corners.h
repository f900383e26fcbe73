/// Corners spread over the image.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "djpete/frontend/options.h"

namespace djpete::frontend {

/// New corners at integer pixels, at least options.minDistance_px from each other and from
/// `existing`, none where `exclusion` (8 bit, may be empty) is not zero. One per grid cell without
/// a feature, row by row, at most `wanted`, the most textured first when there are more.
std::vector<cv::Point2f> detectCorners(const cv::Mat& grey,
                                       const std::vector<cv::Point2f>& existing,
                                       const cv::Mat& exclusion, int wanted,
                                       const FrontendOptions& options);

}  // namespace djpete::frontend
