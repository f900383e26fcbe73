/// Panels, captions, boxes. Private: brings OpenCV. Colours are blue, green, red.
#pragma once

#include <mrpt/img/CImage.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"

namespace djpete::figures {

/// A copy as 8UC3.
cv::Mat colourCopy(const mrpt::img::CImage& image);
/// With a line of text above.
cv::Mat captioned(const cv::Mat& panel, const std::string& text);
/// Side by side on white, all scaled to the height of the first.
cv::Mat beside(const std::vector<cv::Mat>& panels);
/// One above the other on white, all scaled to the width of the first.
cv::Mat below(const std::vector<cv::Mat>& panels);
void text(cv::Mat& on, const std::string& what, const cv::Point& at, const cv::Scalar& colour,
          double size = 0.5);
/// Throws obs::InputError naming the file if it cannot be written.
void save(const cv::Mat& picture, const std::string& file);

/// Of an object, by its id: neighbours in number differ.
cv::Scalar colourOf(int64_t id);
/// The edges of the box of `size_m`, those in front of the camera; its front face is crossed.
void drawBox(cv::Mat& on, const geometry::StereoCamera& camera, const geometry::SE3& T_cam_obj,
             const geometry::Vec3& size_m, const cv::Scalar& colour, int width_px = 2);

/// A camera at `eye` that looks at `target`, z up, with this vertical field of view.
struct VirtualCamera {
    geometry::StereoCamera model;
    geometry::SE3 T_cam_base;  ///< base: the frame of eye and target
};
VirtualCamera lookingAt(const geometry::Vec3& eye, const geometry::Vec3& target, double height_deg,
                        int width_px, int height_px);

}  // namespace djpete::figures
