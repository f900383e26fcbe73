/// A street of textured planes, ray-cast: exact motion, depth and scans for tests of this room.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "djpete/frontend/visual_odometry.h"
#include "djpete/geometry/mrpt_bridge.h"

namespace djpete_test {

using djpete::geometry::SE3;
using djpete::geometry::Vec3;

/// Smooth noise in 0..1 on a lattice of integers.
inline double latticeNoise(double x, double y, uint32_t seed) {
    const auto value = [&](int64_t i, int64_t j) {
        uint64_t h = static_cast<uint64_t>(i) * 0x9E3779B97F4A7C15ULL ^
                     static_cast<uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL ^
                     seed * 0x165667B19E3779F9ULL;
        h ^= h >> 29;
        h *= 0xBF58476D1CE4E5B9ULL;
        h ^= h >> 32;
        return static_cast<double>(h & 0xFFFFU) / 65535.0;
    };
    const double fx = std::floor(x), fy = std::floor(y);
    const auto i = static_cast<int64_t>(fx), j = static_cast<int64_t>(fy);
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double u = smooth(x - fx), v = smooth(y - fy);
    return (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
           v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
}

/// Grey 0..255 of a surface at (a, b) metres, without detail finer than the pixel footprint.
inline double textureGrey(double a, double b, double footprint_m, uint32_t seed) {
    double sum = 0, weight = 0;
    uint32_t octave = 0;
    for (double wavelength = 0.06; wavelength < 4; wavelength *= 2, ++octave) {
        const double w = std::clamp(wavelength / (3 * footprint_m) - 1, 0.0, 1.0);
        sum += w * (latticeNoise(a / wavelength, b / wavelength, seed + octave) - 0.5);
        weight += w;
    }
    return weight > 0 ? std::clamp(128 + 330 * sum / std::sqrt(weight + 2), 0.0, 255.0) : 128;
}

/// A rectangle n . p = d with texture axes; unbounded if `half_m` is not set.
struct TexturedPlane {
    Vec3 normal, centre, axisA, axisB;
    uint32_t seed = 1;
    std::optional<double> half_m;  ///< half side, centre-based
    Vec3 velocity_m{0, 0, 0};      ///< per frame
};

/// World = the camera of frame 0 (z forward, x right, y down).
class SyntheticStreet {
  public:
    SyntheticStreet() {
        camera.model = {360, 360, 320, 120, 0.54, 640, 240};
        camera.T_vehicle_cam =
            SE3(djpete::geometry::opticalToVehicleAxes().rotation(), Vec3(0.27, 0.05, -0.08));
        const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
        planes = {{y, {0, 1.6, 0}, x, z, 11, {}, {0, 0, 0}},
                  {x, {-6, 0, 0}, z, y, 23, {}, {0, 0, 0}},
                  {x, {7, 0, 0}, z, y, 37, {}, {0, 0, 0}},
                  {z, {0, 0, 45}, x, y, 41, {}, {0, 0, 0}}};
    }

    struct Hit {
        double depth = 0;  ///< along the ray, in units of the ray
        const TexturedPlane* plane = nullptr;
        Vec3 p_plane;
    };
    std::optional<Hit> cast(const Vec3& origin, const Vec3& ray, double frame) const {
        std::optional<Hit> best;
        for (const auto& plane : planes) {
            const Vec3 centre = plane.centre + frame * plane.velocity_m;
            const double rate = plane.normal.dot(ray);
            if (std::abs(rate) < 1e-9) continue;
            const double s = plane.normal.dot(centre - origin) / rate;
            if (s <= 0.1 || (best && s >= best->depth)) continue;
            const Vec3 p = origin + s * ray - centre;
            if (plane.half_m && p.cwiseAbs().maxCoeff() > *plane.half_m) continue;
            best = Hit{s, &plane, p};
        }
        return best;
    }
    /// z in cam of the surface at a pixel.
    double depthAt(const SE3& T_world_cam, double u, double v, double frame = 0) const {
        const auto hit = cast(T_world_cam.translation(),
                              T_world_cam.rotation() * camera.model.ray({u, v}), frame);
        return hit ? hit->depth : 0;
    }
    mrpt::img::CImage render(const SE3& T_world_cam, double frame = 0) const {
        const auto width = static_cast<unsigned>(camera.model.width_px);
        const auto height = static_cast<unsigned>(camera.model.height_px);
        mrpt::img::CImage out(width, height, mrpt::img::CH_GRAY);
        for (unsigned v = 0; v < height; ++v) {
            for (unsigned u = 0; u < width; ++u) {
                const Vec3 ray = T_world_cam.rotation() * camera.model.ray({u, v});
                const auto hit = cast(T_world_cam.translation(), ray, frame);
                double grey = 128;
                if (hit) {
                    const double slant = std::abs(hit->plane->normal.dot(ray.normalized()));
                    const double footprint =
                        hit->depth / camera.model.fx / std::max(0.1, std::sqrt(slant));
                    grey = textureGrey(hit->p_plane.dot(hit->plane->axisA),
                                       hit->p_plane.dot(hit->plane->axisB), footprint,
                                       hit->plane->seed);
                }
                *out(u, v) = static_cast<uint8_t>(std::lround(grey));
            }
        }
        return out;
    }
    /// 64 beams over the camera's field of view.
    djpete::obs::LidarScan scan(const SE3& T_world_cam, double frame = 0) const {
        djpete::obs::LidarScan out;
        const SE3 T_cam_velo = camera.T_vehicle_cam.inverse();
        const SE3 T_world_velo = T_world_cam * T_cam_velo;
        for (int beam = 0; beam < 64; ++beam) {
            const double pitch = (3.0 - 0.42 * beam) * M_PI / 180;
            for (double yaw = -0.8; yaw < 0.8; yaw += 0.003) {
                const Vec3 ray(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                               std::sin(pitch));
                const auto hit =
                    cast(T_world_velo.translation(), T_world_velo.rotation() * ray, frame);
                if (!hit || hit->depth > 80) continue;
                const Vec3 p = hit->depth * ray;
                out.points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                      static_cast<float>(p.z()), 0.5F});
            }
        }
        return out;
    }
    djpete::frontend::OdometryInput frame(std::size_t i, const SE3& T_world_cam,
                                          bool stereo = true) const {
        djpete::frontend::OdometryInput in;
        in.frame.value = i;
        in.stamp = mrpt::Clock::fromDouble(1.3e9 + 0.1 * static_cast<double>(i));
        in.images.camera = camera;
        in.images.left = render(T_world_cam, static_cast<double>(i));
        if (stereo) {
            const SE3 T_left_right(Eigen::Matrix3d::Identity(),
                                   Vec3(camera.model.baseline_m, 0, 0));
            in.images.right = render(T_world_cam * T_left_right, static_cast<double>(i));
        } else {
            in.images.camera.model.baseline_m = 0;
        }
        return in;
    }

    djpete::obs::RigCamera camera;
    std::vector<TexturedPlane> planes;
};

}  // namespace djpete_test
