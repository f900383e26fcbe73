#include "djpete/simulator/world.h"

#include <cmath>

#include "car_body.h"
#include "noise.h"
#include "street_builder.h"

namespace djpete::simulator {

namespace {

using geometry::SE3;
using geometry::Vec3;

constexpr double kVeloHeight_m = 1.73;
constexpr double kStart_m = 8.0;     // own vehicle at frame 0
constexpr double kOwnLane_m = -1.6;  // right-hand traffic
constexpr double kParking_m = 4.25;

double streetLength(const WorldOptions& o) {
    return kStart_m + static_cast<double>(o.frames) * o.step_m + 150.0;
}

Car makeCar(uint32_t id, uint32_t seed) {
    Car car;
    car.id = id;
    car.seed = hash(seed, 300U, id);
    car.kind = hash(car.seed, 1U) % kCarBodyKinds;
    car.size_m = makeCarBody(car.kind, car.seed).size_m;
    return car;
}

}  // namespace

World::World(const WorldOptions& options)
    : options_(options), street_(streetLength(options), options.seed) {
    uint32_t id = 1;
    for (uint32_t side = 0; side < 2; ++side) {
        uint32_t n = 0;
        for (double s = 5; s < street_.length_m() - 8;) {
            const uint32_t h = hash(options.seed, 400U + side, n++);
            if (unit(h) < 0.30F) {  // a gap
                s += static_cast<double>(between(hash(h, 1U), 3.F, 9.F));
                continue;
            }
            Car car = makeCar(id++, options.seed);
            car.s0_m = s + 0.5 * car.size_m.x();
            car.lateral_m = (side == 0 ? -1 : 1) *
                            (kParking_m + static_cast<double>(between(hash(h, 2U), -0.12F, 0.12F)));
            car.oncoming = side == 1;
            s += car.size_m.x() + static_cast<double>(between(hash(h, 3U), 1.0F, 3.4F));
            cars_.push_back(car);
        }
    }
    const double ownSpeed = options.step_m / options.period_s;
    Car ahead = makeCar(id++, options.seed);
    ahead.moving = true;
    ahead.s0_m = kStart_m + 16;
    ahead.lateral_m = kOwnLane_m;
    ahead.speed_mps = 1.06 * ownSpeed;
    cars_.push_back(ahead);
    for (double s = kStart_m + 45; s < kStart_m + 45 + 1.6 * static_cast<double>(options.frames);
         s += 38) {
        Car car = makeCar(id++, options.seed);
        car.moving = true;
        car.oncoming = true;
        car.s0_m = s;
        car.lateral_m = -kOwnLane_m;
        car.speed_mps = -static_cast<double>(between(hash(car.seed, 5U), 6.F, 10.F));
        cars_.push_back(car);
    }
}

SE3 World::T_world_obj(const Car& car, uint64_t frame) const {
    const double t = static_cast<double>(frame) * options_.period_s;
    SE3 T = street_.poseAt(car.s0_m + car.speed_mps * t, car.lateral_m);
    if (car.oncoming) T = T * SE3::fromYaw(M_PI, Vec3::Zero());
    return T * SE3(geometry::Mat3::Identity(), Vec3(0, 0, 0.5 * car.size_m.z()));
}

SE3 World::T_world_vehicle(uint64_t frame) const {
    const auto f = static_cast<double>(frame);
    const SE3 T_world_ground =
        street_.poseAt(kStart_m + f * options_.step_m, kOwnLane_m + 0.1 * std::sin(f / 17.0));
    geometry::Vec6 sway;
    sway << 0, 0, kVeloHeight_m + 0.012 * std::sin(f / 2.3), 0.003 * std::sin(f / 5.1),
        0.004 * std::sin(f / 3.7), 0.1 / 17.0 / options_.step_m * std::cos(f / 17.0);
    return T_world_ground * SE3::exp(sway);
}

SE3 T_vehicle_camera() {
    // Camera 8 cm below and 27 cm before the Velodyne, a fraction of a degree askew, like KITTI's.
    geometry::Vec6 askew;
    askew << 0, 0, 0, 0.004, -0.007, 0.002;
    geometry::Mat3 axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return SE3(axes, Vec3(0.27, 0.0, -0.08)) * SE3::exp(askew);
}

geometry::StereoCamera rigCamera(int width_px, int height_px) {
    const double scale = static_cast<double>(width_px) / 1241.0;
    geometry::StereoCamera c;
    c.fx = c.fy = 718.856 * scale;
    c.cx = 607.1928 * scale;
    c.cy = 185.2157 * static_cast<double>(height_px) / 376.0;
    c.baseline_m = 0.537165718;
    c.width_px = width_px;
    c.height_px = height_px;
    return c;
}

}  // namespace djpete::simulator
