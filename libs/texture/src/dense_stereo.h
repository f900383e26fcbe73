/// Depth from a rectified pair on a part of the image. Private: brings OpenCV.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "depth_map.h"
#include "djpete/geometry/camera.h"

namespace djpete::texture {

/// Depth (m) of every pixel of `rect` in the left image between the two depths; 0 where unknown.
/// Semi-global matching with left-right check. CV_32FC1 of the rectangle's size; all zero if the
/// rectangle is too small to match. Pixels around which neighbours differ by less than
/// `minContrast` grey levels are left unknown: there (sky) the matcher invents depth.
cv::Mat denseDepth(const std::array<cv::Mat, 2>& greyPair, const geometry::StereoCamera& camera,
                   const PixelRect& rect, double minDepth_m, double maxDepth_m, double minContrast);

}  // namespace djpete::texture
