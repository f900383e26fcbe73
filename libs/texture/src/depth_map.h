/// A z-buffer over a part of an image.
#pragma once

#include <limits>
#include <vector>

#include "disc.h"

namespace djpete::texture {

/// The smallest depth per pixel of what was drawn; infinity where nothing was.
class DepthMap {
  public:
    explicit DepthMap(const PixelRect& rect);

    /// Draws a rectangle of constant depth around pixel (u, v).
    void drawPoint(const geometry::Vec2& uv, double depth_m, double halfWidth_px,
                   double halfHeight_px);
    /// Draws a disc of `radius_m` with its own slope: plane through p_cam with `normal_cam`,
    /// which need not face the camera. Almost edge-on discs are drawn facing the camera.
    void drawDisc(const geometry::StereoCamera& camera, const geometry::Vec3& p_cam,
                  const geometry::Vec3& normal_cam, double radius_m);

    /// Infinity outside the rectangle.
    float at(int x, int y) const {
        return rect_.contains(x, y) ? depth_[index(x, y)] : std::numeric_limits<float>::infinity();
    }
    const PixelRect& rect() const { return rect_; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - rect_.y0) * width_ +
               static_cast<std::size_t>(x - rect_.x0);
    }
    PixelRect rect_;
    std::size_t width_ = 0;
    std::vector<float> depth_;
};

}  // namespace djpete::texture
