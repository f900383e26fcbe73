#include "depth_map.h"

#include <algorithm>

namespace djpete::texture {

DepthMap::DepthMap(const PixelRect& rect) : rect_(rect) {
    if (rect_.empty()) rect_ = PixelRect();
    width_ = static_cast<std::size_t>(rect_.x1 - rect_.x0);
    inverse_.assign(width_ * static_cast<std::size_t>(rect_.y1 - rect_.y0), 0);
}

void DepthMap::drawPoint(const geometry::Vec2& uv, double depth_m, double halfWidth_px,
                         double halfHeight_px) {
    const PixelRect r = around(uv, halfWidth_px, halfHeight_px, rect_);
    const auto inverseDepth = static_cast<float>(1 / depth_m);
    for (int y = r.y0; y < r.y1; ++y) {
        for (int x = r.x0; x < r.x1; ++x) {
            float& stored = inverse_[index(x, y)];
            stored = std::max(stored, inverseDepth);
        }
    }
}

}  // namespace djpete::texture
