/// The pixels of a disc in space.
#pragma once

#include <algorithm>
#include <cmath>

#include "djpete/geometry/camera.h"

namespace djpete::texture {

/// Pixels [x0, x1) x [y0, y1).
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x1 <= x0 || y1 <= y0; }
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

/// The part of `rect` within so many pixels of uv; extents beyond any useful splat are cut.
inline PixelRect around(const geometry::Vec2& uv, double halfWidth_px, double halfHeight_px,
                        const PixelRect& rect) {
    constexpr double kMaxExtent_px = 200;  // keeps int conversion safe
    const double hw = std::min(halfWidth_px, kMaxExtent_px);
    const double hh = std::min(halfHeight_px, kMaxExtent_px);
    const double u = std::clamp(uv.x(), rect.x0 - 2 * kMaxExtent_px, rect.x1 + 2 * kMaxExtent_px);
    const double v = std::clamp(uv.y(), rect.y0 - 2 * kMaxExtent_px, rect.y1 + 2 * kMaxExtent_px);
    return {std::max(rect.x0, static_cast<int>(std::floor(u - hw + 0.5))),
            std::max(rect.y0, static_cast<int>(std::floor(v - hh + 0.5))),
            std::min(rect.x1, static_cast<int>(std::floor(u + hw + 0.5)) + 1),
            std::min(rect.y1, static_cast<int>(std::floor(v + hh + 0.5)) + 1)};
}

/// Calls visit(x, y, depth_m, distance2_m2) for every pixel of `rect` whose ray meets the disc of
/// `radius_m` around p_cam with `normal_cam`, which need not face the camera. Almost edge-on discs
/// are taken as facing the camera. distance2: squared, from the disc's centre.
template <class Visit>
void forDisc(const geometry::StereoCamera& camera, const geometry::Vec3& p_cam,
             const geometry::Vec3& normal_cam, double radius_m, const PixelRect& rect,
             const Visit& visit) {
    constexpr double kEdgeOnCos = 0.15;
    const geometry::Vec2 uv = camera.project(p_cam);
    const double facing = normal_cam.dot(p_cam) / p_cam.norm();
    const geometry::Vec3 n =
        std::abs(facing) < kEdgeOnCos ? geometry::Vec3(0, 0, 1) : normal_cam.normalized();
    const double toPixel = radius_m / p_cam.z();
    const PixelRect r = around(uv, camera.fx * toPixel, camera.fy * toPixel, rect);
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
            const float distance2 = ex * ex + ey * ey + ez * ez;
            if (distance2 <= radius2) visit(x, y, z, distance2);
        }
    }
}

}  // namespace djpete::texture
