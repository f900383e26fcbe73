#include "depth_map.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

constexpr double kMaxExtent_px = 200;  // beyond any useful splat; keeps int conversion safe
constexpr double kEdgeOnCos = 0.15;

}  // namespace

DepthMap::DepthMap(const PixelRect& rect) : rect_(rect) {
    if (rect_.empty()) rect_ = PixelRect();
    width_ = static_cast<std::size_t>(rect_.x1 - rect_.x0);
    depth_.assign(width_ * static_cast<std::size_t>(rect_.y1 - rect_.y0),
                  std::numeric_limits<float>::infinity());
}

PixelRect DepthMap::clip(const geometry::Vec2& uv, double halfWidth_px,
                         double halfHeight_px) const {
    const double hw = std::min(halfWidth_px, kMaxExtent_px);
    const double hh = std::min(halfHeight_px, kMaxExtent_px);
    const double u = std::clamp(uv.x(), rect_.x0 - 2 * kMaxExtent_px, rect_.x1 + 2 * kMaxExtent_px);
    const double v = std::clamp(uv.y(), rect_.y0 - 2 * kMaxExtent_px, rect_.y1 + 2 * kMaxExtent_px);
    return {std::max(rect_.x0, static_cast<int>(std::floor(u - hw + 0.5))),
            std::max(rect_.y0, static_cast<int>(std::floor(v - hh + 0.5))),
            std::min(rect_.x1, static_cast<int>(std::floor(u + hw + 0.5)) + 1),
            std::min(rect_.y1, static_cast<int>(std::floor(v + hh + 0.5)) + 1)};
}

void DepthMap::drawPoint(const geometry::Vec2& uv, double depth_m, double halfWidth_px,
                         double halfHeight_px) {
    const PixelRect r = clip(uv, halfWidth_px, halfHeight_px);
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
    const geometry::Vec2 uv = camera.project(p_cam);
    const double facing = normal_cam.dot(p_cam) / p_cam.norm();
    const geometry::Vec3 n =
        std::abs(facing) < kEdgeOnCos ? geometry::Vec3(0, 0, 1) : normal_cam.normalized();
    const double toPixel = radius_m / p_cam.z();
    const PixelRect r = clip(uv, camera.fx * toPixel, camera.fy * toPixel);
    // Ray (x, y, 1) meets the plane at depth n.p / n.ray; within the disc if that point is near p.
    const auto plane = static_cast<float>(n.dot(p_cam));
    const auto nx = static_cast<float>(n.x() / camera.fx);
    const auto ny = static_cast<float>(n.y() / camera.fy);
    const auto radius2 = static_cast<float>(radius_m * radius_m);
    const auto px = static_cast<float>(p_cam.x()), py = static_cast<float>(p_cam.y()),
               pz = static_cast<float>(p_cam.z());
    const auto fxInv = static_cast<float>(1 / camera.fx), fyInv = static_cast<float>(1 / camera.fy);
    const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
    for (int y = r.y0; y < r.y1; ++y) {
        const float dy = static_cast<float>(y) - cy;
        const float rowDot = static_cast<float>(n.z()) + ny * dy;
        for (int x = r.x0; x < r.x1; ++x) {
            const float dx = static_cast<float>(x) - cx;
            const float z = plane / (rowDot + nx * dx);
            if (!(z > 0)) continue;
            const float ex = z * dx * fxInv - px, ey = z * dy * fyInv - py, ez = z - pz;
            if (ex * ex + ey * ey + ez * ez > radius2) continue;
            float& stored = depth_[index(x, y)];
            stored = std::min(stored, z);
        }
    }
}

}  // namespace djpete::texture
