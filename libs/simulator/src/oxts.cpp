#include "djpete/simulator/oxts.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "noise.h"
#include "vehicle_motion.h"

namespace djpete::simulator {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;

namespace {

constexpr double kEarthRadius_m = 6378137.0;
constexpr double kGravity_mps2 = 9.81;

/// Axes of the noise sources.
enum Source : uint32_t { kPosition, kAngle, kVelocity, kAcceleration, kTurnRate };

struct OxtsError {
    uint32_t seed;
    uint64_t frame;

    double at(Source source, uint32_t axis, uint64_t when) const {
        return static_cast<double>(
            gaussian(hash(seed, source * 3U + axis, static_cast<uint32_t>(when))));
    }
    /// Normal with sigma 1 in each number, new for every frame.
    Vec3 white(Source s) const { return {at(s, 0, frame), at(s, 1, frame), at(s, 2, frame)}; }
    /// The same, but it glides from one value to the next over 50 frames.
    Vec3 slow(Source s) const {
        constexpr uint64_t kSpan = 50;
        const uint64_t cell = frame / kSpan;
        const double w = static_cast<double>(frame % kSpan) / kSpan;
        Vec3 e;
        for (uint32_t k = 0; k < 3; ++k) e[k] = (1 - w) * at(s, k, cell) + w * at(s, k, cell + 1);
        return e / std::hypot(1 - w, w);
    }
};

/// Velocity of the unit in the world.
Vec3 velocityOf(const World& world, uint64_t frame) {
    const geometry::Vec6 twist_vehicle = vehicleTwist(world, frame);
    const Vec3 v = twist_vehicle.head<3>(), w = twist_vehicle.tail<3>();
    return world.T_world_vehicle(frame).rotation() * (v + w.cross(T_velo_imu().translation()));
}

Vec3 accelerationOf(const World& world, uint64_t frame) {
    const uint64_t before = frame > 0 ? frame - 1 : 0, after = frame + 1;
    return (velocityOf(world, after) - velocityOf(world, before)) /
           (static_cast<double>(after - before) * world.options().period_s);
}

}  // namespace

SE3 T_velo_imu() { return {Mat3::Identity(), Vec3(-0.81, 0.32, -0.80)}; }

std::string oxtsRow(const World& world, uint64_t frame, const OxtsNoise& noise,
                    const GeoOrigin& origin) {
    constexpr double kDeg = M_PI / 180.0;
    const OxtsError error{hash(world.driveSeed(), 950U), frame};
    const SE3 T_world_imu = world.T_world_vehicle(frame) * T_velo_imu();
    const Vec3 start = (world.T_world_start() * T_velo_imu()).translation();
    const Vec3 p = T_world_imu.translation() - start + noise.position_m * error.slow(kPosition);

    const double scale = std::cos(origin.lat_deg * kDeg);
    const double lon_deg = origin.lon_deg + p.x() / (scale * kEarthRadius_m) / kDeg;
    const double north0 = std::log(std::tan((90 + origin.lat_deg) * kDeg / 2));
    const double north = north0 + p.y() / (scale * kEarthRadius_m);
    const double lat_deg = 2 * std::atan(std::exp(north)) / kDeg - 90;

    const Mat3 R = T_world_imu.rotation();  // = Rz(yaw) Ry(pitch) Rx(roll)
    const Vec3 angles =
        Vec3(std::atan2(R(2, 1), R(2, 2)), -std::asin(std::min(1.0, std::max(-1.0, R(2, 0)))),
             std::atan2(R(1, 0), R(0, 0))) +
        noise.angle_rad * error.slow(kAngle);
    const Vec3 v_world = velocityOf(world, frame) + noise.velocity_mps * error.white(kVelocity);
    // Forward and left on the level: the vehicle's heading without its pitch and roll.
    const Mat3 R_level_world = SE3::fromYaw(angles.z(), Vec3::Zero()).rotation().transpose();
    const Vec3 v_level = R_level_world * v_world;
    const Vec3 a_imu = R.transpose() * (accelerationOf(world, frame) + Vec3(0, 0, kGravity_mps2)) +
                       noise.acceleration_mps2 * error.white(kAcceleration);
    const Vec3 a_level = R_level_world * R * a_imu;
    const Vec3 w_imu =
        vehicleTwist(world, frame).tail<3>() + noise.turnRate_radps * error.white(kTurnRate);
    const Vec3 w_level = R_level_world * R * w_imu;

    const std::array<double, 25> numbers{lat_deg,           lon_deg,     p.z() + origin.alt_m,
                                         angles.x(),        angles.y(),  angles.z(),
                                         v_world.y(),       v_world.x(), v_level.x(),
                                         v_level.y(),       v_level.z(), a_imu.x(),
                                         a_imu.y(),         a_imu.z(),   a_level.x(),
                                         a_level.y(),       a_level.z(), w_imu.x(),
                                         w_imu.y(),         w_imu.z(),   w_level.x(),
                                         w_level.y(),       w_level.z(), noise.position_m,
                                         noise.velocity_mps};
    std::string row;
    char number[40];
    for (double x : numbers) {
        std::snprintf(number, sizeof number, "%.13g ", x);
        row += number;
    }
    return row + "4 10 5 5 5";
}

}  // namespace djpete::simulator
