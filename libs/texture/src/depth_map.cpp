#include "depth_map.h"

#include <algorithm>

namespace djpete::texture {

DepthMap::DepthMap(const PixelRect& rect) : rect_(rect) {
    if (rect_.empty()) rect_ = PixelRect();
    width_ = static_cast<std::size_t>(rect_.x1 - rect_.x0);
    depth_.assign(width_ * static_cast<std::size_t>(rect_.y1 - rect_.y0),
                  std::numeric_limits<float>::infinity());
}

void DepthMap::drawPoint(const geometry::Vec2& uv, double depth_m, double halfWidth_px,
                         double halfHeight_px) {
    const PixelRect r = around(uv, halfWidth_px, halfHeight_px, rect_);
    const auto depth = static_cast<float>(depth_m);
    for (int y = r.y0; y < r.y1; ++y) {
        for (int x = r.x0; x < r.x1; ++x) {
            float& z = depth_[index(x, y)];
            z = std::min(z, depth);
        }
    }
}

void DepthMap::drawDisc(const geometry::StereoCamera& camera, const geometry::Vec3& p_cam,
                        const geometry::Vec3& normal_cam, double radius_m) {
    forDisc(camera, p_cam, normal_cam, radius_m, rect_, [&](int x, int y, float z, float) {
        float& stored = depth_[index(x, y)];
        stored = std::min(stored, z);
    });
}

}  // namespace djpete::texture
