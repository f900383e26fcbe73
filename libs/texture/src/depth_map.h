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
    /// Draws a disc with its own slope.
    void drawDisc(const DiscInImage& disc) {
        disc.forPixels(rect_, [&](int x, int y, float inverseDepth, float) {
            float& stored = inverse_[index(x, y)];
            stored = std::max(stored, inverseDepth);
        });
    }

    /// Infinity outside the rectangle.
    float at(int x, int y) const {
        return 1 / (rect_.contains(x, y) ? inverse_[index(x, y)] : 0.0F);
    }
    /// False where at() is infinite.
    bool has(int x, int y) const {
        // A depth beyond all floats counts as none.
        return rect_.contains(x, y) && inverse_[index(x, y)] >= kLeastInverse;
    }
    const PixelRect& rect() const { return rect_; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - rect_.y0) * width_ +
               static_cast<std::size_t>(x - rect_.x0);
    }
    static constexpr float kLeastInverse = 1 / std::numeric_limits<float>::max();
    PixelRect rect_;
    std::size_t width_ = 0;
    std::vector<float> inverse_;  ///< 0: nothing
};

}  // namespace djpete::texture
