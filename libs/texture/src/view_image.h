/// The left image of a view, checked, and masks in it. Private: brings OpenCV.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "djpete/texture/texture_view.h"

namespace djpete::texture {

/// Shares the pixels of the view.
struct ViewImage {
    cv::Mat pixels;  ///< 8UC1 or 8UC3 (blue, green, red)
    geometry::StereoCamera camera;

    /// Red, green, blue, bilinear; (u, v) at least one pixel inside.
    std::array<float, 3> sample(const geometry::Vec2& uv) const;
};

/// Throws obs::InputError, naming the frame, if there is no 8-bit image, it does not fit its
/// calibration, or the camera has none.
ViewImage checkedImage(const TextureView& view);

/// 8UC1 of the image's size: 255 where the mask is, eroded by `border_px` (dilated if negative).
/// Throws obs::InputError naming frame and object if the mask does not fit the image.
cv::Mat denseMask(const obs::RleMask& mask, int border_px, const cv::Size& imageSize,
                  const TextureView& view, map::ObjectId object);

/// Both images grey; throws obs::InputError if they differ in size. Requires a right image.
std::array<cv::Mat, 2> greyPair(const TextureView& view);

}  // namespace djpete::texture
