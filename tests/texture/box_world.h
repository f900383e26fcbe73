/// A world of coloured boxes on a plane, ray-cast into small images and scans.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "djpete/texture/texture_view.h"

namespace djpete_test {

using djpete::geometry::SE3;
using djpete::geometry::StereoCamera;
using djpete::geometry::Vec2;
using djpete::geometry::Vec3;
using Rgb = std::array<uint8_t, 3>;

/// Faces in order +x, -x, +y, -y, +z, -z.
struct ColourBox {
    SE3 T_world_box;
    Vec3 size_m{4, 1.8, 1.5};
    std::array<Rgb, 6> faces;
    double speckle_m = 0;  ///< darkened by a fixed random pattern of this grain; 0: plain
};

inline std::array<Rgb, 6> allFaces(const Rgb& rgb) { return {rgb, rgb, rgb, rgb, rgb, rgb}; }

struct Hit {
    double range = std::numeric_limits<double>::infinity();
    Rgb rgb{255, 0, 255};  ///< the sky is magenta, so that it shows wherever it bleeds
    int box = -1;          ///< -1: sky or ground
};

inline double speckle(double a, double b, double grain_m) {
    const auto cellA = static_cast<uint64_t>(std::floor(a / grain_m) + 1000);
    const auto cellB = static_cast<uint64_t>(std::floor(b / grain_m) + 1000);
    uint64_t h = (cellA * 73856093ULL) ^ (cellB * 19349663ULL);
    h = (h ^ (h >> 13U)) * 0x9E3779B97F4A7C15ULL;
    return 0.4 + 0.6 * static_cast<double>(h >> 40U) / static_cast<double>(1U << 24U);
}

struct BoxWorld {
    std::vector<ColourBox> boxes;
    std::optional<Rgb> ground;  ///< plane z = 0

    Hit cast(const Vec3& from, const Vec3& direction) const {
        Hit hit;
        if (ground && direction.z() < 0 && from.z() > 0) {
            hit.range = -from.z() / direction.z();
            hit.rgb = *ground;
        }
        for (std::size_t b = 0; b < boxes.size(); ++b)
            castBox(static_cast<int>(b), from, direction, hit);
        return hit;
    }

    mrpt::img::CImage image(const StereoCamera& camera, const SE3& T_world_cam,
                            double brightness = 1) const {
        mrpt::img::CImage out(camera.width_px, camera.height_px, mrpt::img::CH_RGB);
        for (int v = 0; v < camera.height_px; ++v) {
            for (int u = 0; u < camera.width_px; ++u) {
                const Hit hit = cast(T_world_cam.translation(),
                                     T_world_cam.rotation() * camera.ray(Vec2(u, v)));
                for (unsigned c = 0; c < 3; ++c) {  // stored blue first
                    out.at<uint8_t>(static_cast<unsigned>(u), static_cast<unsigned>(v),
                                    static_cast<int8_t>(2 - c)) =
                        static_cast<uint8_t>(std::lround(brightness * hit.rgb[c]));
                }
            }
        }
        return out;
    }

    /// Every `step_deg` in azimuth, 0.4 degrees in elevation, returns of boxes and ground.
    djpete::obs::LidarScan scan(const SE3& T_world_velo, double step_deg = 0.18) const {
        djpete::obs::LidarScan out;
        const double toRad = M_PI / 180;
        for (double elevation = -24; elevation < 3; elevation += 0.4) {
            for (double azimuth = -180; azimuth < 180; azimuth += step_deg) {
                const Vec3 d(std::cos(elevation * toRad) * std::cos(azimuth * toRad),
                             std::cos(elevation * toRad) * std::sin(azimuth * toRad),
                             std::sin(elevation * toRad));
                const Hit hit = cast(T_world_velo.translation(), T_world_velo.rotation() * d);
                if (!(hit.range < 80)) continue;
                const Vec3 p = hit.range * d;
                out.points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                      static_cast<float>(p.z()), 0.5F});
            }
        }
        return out;
    }

    /// Pixels whose first hit is box `index`.
    djpete::obs::RleMask mask(int index, const StereoCamera& camera, const SE3& T_world_cam) const {
        std::vector<uint8_t> dense;
        for (int v = 0; v < camera.height_px; ++v) {
            for (int u = 0; u < camera.width_px; ++u) {
                const Hit hit = cast(T_world_cam.translation(),
                                     T_world_cam.rotation() * camera.ray(Vec2(u, v)));
                dense.push_back(hit.box == index ? 255 : 0);
            }
        }
        const auto width = static_cast<uint32_t>(camera.width_px);
        return djpete::obs::RleMask::fromDense(dense.data(), width,
                                               static_cast<uint32_t>(camera.height_px), width);
    }

  private:
    void castBox(int index, const Vec3& from, const Vec3& direction, Hit& best) const {
        const ColourBox& box = boxes[static_cast<std::size_t>(index)];
        const SE3 T_box_world = box.T_world_box.inverse();
        const Vec3 o = T_box_world * from, d = T_box_world.rotation() * direction;
        double enter = 0, leave = std::numeric_limits<double>::infinity();
        int face = -1;
        for (int i = 0; i < 3; ++i) {
            const double half = 0.5 * box.size_m[i];
            if (std::abs(d[i]) < 1e-12) {
                if (std::abs(o[i]) > half) return;
                continue;
            }
            const double near = ((d[i] > 0 ? -half : half) - o[i]) / d[i];
            const double far = ((d[i] > 0 ? half : -half) - o[i]) / d[i];
            if (near > enter) {
                enter = near;
                face = 2 * i + (d[i] > 0 ? 1 : 0);
            }
            leave = std::min(leave, far);
        }
        if (face < 0 || enter >= leave || enter >= best.range) return;
        best.range = enter;
        best.box = index;
        best.rgb = box.faces[static_cast<std::size_t>(face)];
        if (box.speckle_m <= 0) return;
        const Vec3 p = o + enter * d;
        const int axis = face / 2;
        const double s = speckle(p[(axis + 1) % 3], p[(axis + 2) % 3], box.speckle_m);
        for (auto& c : best.rgb) c = static_cast<uint8_t>(std::lround(s * c));
    }
};

/// Face of a box of this size that p_obj lies on (nearest), and its distance to the nearest edge.
struct OnFace {
    int face = 0;
    double toEdge_m = 0;
};
inline OnFace nearestFace(const Vec3& p_obj, const Vec3& size_m) {
    OnFace out;
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const double apart = std::abs(std::abs(p_obj[i]) - 0.5 * size_m[i]);
        if (apart >= nearest) continue;
        nearest = apart;
        out.face = 2 * i + (p_obj[i] > 0 ? 0 : 1);
        out.toEdge_m = std::numeric_limits<double>::infinity();
        for (int j = 0; j < 3; ++j) {
            if (j != i) out.toEdge_m = std::min(out.toEdge_m, 0.5 * size_m[j] - std::abs(p_obj[j]));
        }
    }
    return out;
}

/// A camera at `eye` that looks at `target`, z up.
inline SE3 lookAt(const Vec3& eye, const Vec3& target) {
    djpete::geometry::Mat3 R;
    const Vec3 forward = (target - eye).normalized();
    const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
    R.col(0) = right;
    R.col(1) = forward.cross(right);
    R.col(2) = forward;
    return {R, eye};
}

inline StereoCamera smallCamera() {
    StereoCamera c;
    c.fx = c.fy = 360;
    c.cx = 199.5;
    c.cy = 119.5;
    c.width_px = 400;
    c.height_px = 240;
    return c;
}

}  // namespace djpete_test
