/// The pixels of a disc in space.
#pragma once

#include <Eigen/Geometry>
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

/// The largest integer not above x, which must fit. Faster than the library's, which older
/// processors need.
template <class Real>
int floorToInt(Real x) {
    const int towardsZero = static_cast<int>(x);
    return towardsZero - (x < static_cast<Real>(towardsZero) ? 1 : 0);
}

/// The part of `rect` within so many pixels of uv; extents beyond any useful splat are cut.
inline PixelRect around(const geometry::Vec2& uv, double halfWidth_px, double halfHeight_px,
                        const PixelRect& rect) {
    constexpr double kMaxExtent_px = 200;  // keeps int conversion safe
    const double hw = std::min(halfWidth_px, kMaxExtent_px);
    const double hh = std::min(halfHeight_px, kMaxExtent_px);
    const double u = std::clamp(uv.x(), rect.x0 - 2 * kMaxExtent_px, rect.x1 + 2 * kMaxExtent_px);
    const double v = std::clamp(uv.y(), rect.y0 - 2 * kMaxExtent_px, rect.y1 + 2 * kMaxExtent_px);
    return {std::max(rect.x0, floorToInt(u - hw + 0.5)),
            std::max(rect.y0, floorToInt(v - hh + 0.5)),
            std::min(rect.x1, floorToInt(u + hw + 0.5) + 1),
            std::min(rect.y1, floorToInt(v + hh + 0.5) + 1)};
}

/// A disc in space as the camera sees it: an ellipse (to first order around its centre) with
/// inverse depths that are linear in the pixel.
class DiscInImage {
  public:
    /// The disc of `radius_m` around p_cam (before the camera) with `normal_cam`, a unit vector
    /// that need not face the camera. Almost edge-on discs are taken as facing the camera.
    DiscInImage(const geometry::StereoCamera& camera, const Eigen::Vector3f& p_cam,
                const Eigen::Vector3f& normal_cam, float radius_m) {
        constexpr float kEdgeOnCos = 0.15F;
        const float along = normal_cam.dot(p_cam);
        const bool edgeOn = along * along < kEdgeOnCos * kEdgeOnCos * p_cam.squaredNorm();
        const Eigen::Vector3f n = edgeOn ? Eigen::Vector3f(0, 0, 1) : normal_cam;
        const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
        const float iz = 1 / p_cam.z();
        const float xn = p_cam.x() * iz, yn = p_cam.y() * iz;
        u_ = fx * xn + static_cast<float>(camera.cx);
        v_ = fy * yn + static_cast<float>(camera.cy);
        // 1 / depth = n . ray / n . p
        const float perPlane = 1 / (edgeOn ? p_cam.z() : along);
        slopeX_ = n.x() * perPlane / fx;
        slopeY_ = n.y() * perPlane / fy;
        inverseDepth_ = iz;
        // Two radii of the disc and where they show.
        const Eigen::Vector3f other =
            std::abs(n.x()) < 0.6F ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 1, 0);
        const Eigen::Vector3f s = radius_m * n.cross(other).normalized();
        const Eigen::Vector3f t = n.cross(s);
        const float a = fx * iz * (s.x() - xn * s.z()), b = fx * iz * (t.x() - xn * t.z());
        const float c = fy * iz * (s.y() - yn * s.z()), d = fy * iz * (t.y() - yn * t.z());
        halfWidth_ = std::sqrt(a * a + b * b);
        halfHeight_ = std::sqrt(c * c + d * d);
        const float determinant = a * d - b * c;
        const float inverse = determinant == 0 ? 0 : 1 / determinant;
        ia_ = d * inverse;
        ib_ = -b * inverse;
        ic_ = -c * inverse;
        id_ = a * inverse;
    }

    /// Calls visit(x, y, inverse depth, squared distance from the centre in radii) for every pixel
    /// of `rect` in the disc, and for the pixel at its centre if it is smaller than that.
    template <class Visit>
    void forPixels(const PixelRect& rect, const Visit& visit) const {
        const PixelRect r = around(geometry::Vec2(u_, v_), halfWidth_, halfHeight_, rect);
        const DiscInImage d = *this;  // what visit writes cannot change it
        const int centreX = floorToInt(d.u_ + 0.5F), centreY = floorToInt(d.v_ + 0.5F);
        for (int y = r.y0; y < r.y1; ++y) {
            const float dy = static_cast<float>(y) - d.v_;
            for (int x = r.x0; x < r.x1; ++x) {
                const float dx = static_cast<float>(x) - d.u_;
                const float s = d.ia_ * dx + d.ib_ * dy, t = d.ic_ * dx + d.id_ * dy;
                const float distance2 = s * s + t * t;
                const float inverseDepth = d.inverseDepth_ + d.slopeX_ * dx + d.slopeY_ * dy;
                if (distance2 <= 1 && inverseDepth > 0) {
                    visit(x, y, inverseDepth, distance2);
                } else if (x == centreX && y == centreY) {
                    visit(x, y, d.inverseDepth_, 1.0F);
                }
            }
        }
    }

  private:
    float u_ = 0, v_ = 0, halfWidth_ = 0, halfHeight_ = 0;
    float inverseDepth_ = 0, slopeX_ = 0, slopeY_ = 0;
    float ia_ = 0, ib_ = 0, ic_ = 0, id_ = 0;
};

}  // namespace djpete::texture
