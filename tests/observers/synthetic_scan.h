/// A 64-beam LiDAR over a plane with boxes on it: just enough of a street to test a detector.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "djpete/geometry/cuboid.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete_test {

/// A box that stands on the ground; pose in the ground's frame (z = 0 on the ground).
struct Block {
    double x, y, yaw_rad;
    djpete::geometry::Vec3 size_m;
    /// Height of its lower side over the ground.
    double lift_m = 0;
};

struct SyntheticStreet {
    std::vector<Block> blocks;
    bool ground = true;
    djpete::geometry::SE3 T_velo_ground{djpete::geometry::Mat3::Identity(), {0, 0, -1.73}};
    unsigned seed = 1;
    double noise_m = 0.015;

    /// A car as KITTI's scans show it: body, and a cabin that is narrower and shorter.
    void addCar(double x, double y, double yaw_rad, double length = 4.2, double width = 1.75,
                double height = 1.5) {
        blocks.push_back({x, y, yaw_rad, {length, width, 0.72}, 0.2});
        blocks.push_back({x, y, yaw_rad, {0.6 * length, 0.86 * width, height - 0.92}, 0.92});
    }
    djpete::geometry::SE3 poseOf(const Block& b) const {
        using djpete::geometry::SE3;
        return T_velo_ground * SE3::fromYaw(b.yaw_rad, {b.x, b.y, b.lift_m + 0.5 * b.size_m.z()});
    }

    djpete::obs::LidarScan scan() const {
        using namespace djpete::geometry;
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, noise_m);
        std::vector<SE3> T_block_velo;
        for (const auto& b : blocks) T_block_velo.push_back(poseOf(b).inverse());
        const SE3 T_ground_velo = T_velo_ground.inverse();
        djpete::obs::LidarScan out;
        for (int ring = 0; ring < 64; ++ring) {
            const double elevation = (2.0 - ring * 26.8 / 63.0) * M_PI / 180.0;
            for (int step = 0; step < 1800; ++step) {
                const double azimuth = step * 0.2 * M_PI / 180.0;
                const Vec3 ray(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
                double range = ground ? groundRange(T_ground_velo, ray) : kNone;
                for (std::size_t i = 0; i < blocks.size(); ++i) {
                    range = std::min(range, blockRange(T_block_velo[i], ray, blocks[i].size_m));
                }
                if (range > 80 || range < 2) continue;
                const Vec3 p = (range + noise(random)) * ray;
                out.points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                      static_cast<float>(p.z()), 0.3F});
            }
        }
        return out;
    }

  private:
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    static double groundRange(const djpete::geometry::SE3& T_ground_velo,
                              const djpete::geometry::Vec3& ray) {
        const double fall = (T_ground_velo.rotation() * ray).z();
        return fall < -1e-6 ? -T_ground_velo.translation().z() / fall : kNone;
    }
    static double blockRange(const djpete::geometry::SE3& T_block_velo,
                             const djpete::geometry::Vec3& ray,
                             const djpete::geometry::Vec3& size_m) {
        const djpete::geometry::Vec3 o = T_block_velo.translation();
        const djpete::geometry::Vec3 d = T_block_velo.rotation() * ray;
        double enter = 0, leave = kNone;
        for (int k = 0; k < 3; ++k) {
            if (std::abs(d[k]) < 1e-12) {
                if (std::abs(o[k]) > 0.5 * size_m[k]) return kNone;
                continue;
            }
            const double a = (-0.5 * size_m[k] - o[k]) / d[k], b = (0.5 * size_m[k] - o[k]) / d[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter < leave && enter > 0 ? enter : kNone;
    }
};

/// A camera at the sensor that looks ahead, KITTI's size.
inline djpete::obs::RigCamera forwardCamera() {
    djpete::obs::RigCamera camera;
    camera.model = {720, 720, 610, 175, 0, 1242, 375};
    djpete::geometry::Mat3 R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.T_vehicle_cam = djpete::geometry::SE3(R, {0.27, 0, -0.08});
    return camera;
}

}  // namespace djpete_test
