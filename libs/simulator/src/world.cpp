#include "djpete/simulator/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "actor_body.h"
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
    constexpr double kView_m = 200.0, kBlock_m = 1000.0;
    const double needed = kStart_m + static_cast<double>(o.frames) * o.step_m + kView_m;
    return kBlock_m * std::ceil(needed / kBlock_m);
}

Actor makeVehicle(uint32_t id, uint32_t seed) {
    Actor actor;
    actor.id = id;
    actor.seed = hash(seed, 300U, id);
    const uint32_t body = hash(actor.seed, 1U) % kVehicleBodies.size();
    actor.type = kVehicleBodies[body].type;
    actor.kind = kVehicleBodies[body].kind;
    actor.size_m = bodySize(actor);
    return actor;
}

}  // namespace

const char* nameOf(ActorType type) {
    switch (type) {
        case ActorType::Van:
            return "Van";
        case ActorType::Truck:
            return "Truck";
        case ActorType::Pedestrian:
            return "Pedestrian";
        case ActorType::Cyclist:
            return "Cyclist";
        default:
            return "Car";
    }
}

World::World(const WorldOptions& options)
    : options_(options), street_(streetLength(options), options.seed) {
    park();
    addTraffic();
    constexpr std::size_t kMostIds = 999;  // of a class in KITTI's MOTS coding
    if (actors_.size() > kMostIds) {
        throw std::runtime_error("The street of " + std::to_string(options.frames) +
                                 " frames has " + std::to_string(actors_.size()) +
                                 " cars, but masks can tell only " + std::to_string(kMostIds) +
                                 " apart: fewer frames or a smaller step are needed");
    }
}

/// Cars at both kerbs, with gaps; numbered from the start of the street.
void World::park() {
    std::array<double, 2> s{5, 5};
    std::array<uint32_t, 2> n{0, 0};
    while (std::min(s[0], s[1]) < street_.length_m() - 8) {
        const std::size_t side = s[0] <= s[1] ? 0 : 1;
        const uint32_t h = hash(options_.seed, 400U + static_cast<uint32_t>(side), n[side]++);
        if (unit(h) < 0.34F) {  // a gap
            s[side] += static_cast<double>(between(hash(h, 1U), 3.F, 11.F));
            continue;
        }
        Actor actor = makeVehicle(static_cast<uint32_t>(actors_.size()) + 1, options_.seed);
        actor.s0_m = s[side] + 0.5 * actor.size_m.x();
        actor.lateral_m = (side == 0 ? -1 : 1) *
                          (kParking_m + static_cast<double>(between(hash(h, 2U), -0.12F, 0.12F)));
        actor.oncoming = (side == 1) != (unit(hash(h, 4U)) < 0.12F);  // a few face the wrong way
        s[side] += actor.size_m.x() + static_cast<double>(between(hash(h, 3U), 1.0F, 3.4F));
        actors_.push_back(actor);
    }
}

/// One car ahead, one behind, and some that come towards us.
void World::addTraffic() {
    const double ownSpeed = options_.step_m / options_.period_s;
    uint32_t id = static_cast<uint32_t>(actors_.size()) + 1;
    const auto add = [&](double s0_m, double lateral_m, double speed_mps) {
        Actor actor = makeVehicle(id++, options_.seed);
        actor.moving = true;
        actor.oncoming = speed_mps < 0;
        actor.s0_m = s0_m;
        actor.lateral_m = lateral_m;
        actor.speed_mps = speed_mps;
        actors_.push_back(actor);
    };
    add(kStart_m + 16, kOwnLane_m, 1.06 * ownSpeed);
    add(kStart_m - 14, kOwnLane_m, ownSpeed);
    // Equal speeds: they never run into each other.
    const double speed = -static_cast<double>(between(hash(options_.seed, 410U), 7.F, 10.F));
    uint32_t n = 0;
    for (double s = kStart_m + 30; s < 2 * street_.length_m();
         s += static_cast<double>(between(hash(options_.seed, 411U, n++), 22.F, 75.F)))
        add(s, -kOwnLane_m, speed);
}

bool World::present(const Actor& actor, uint64_t frame) const {
    const double s = actor.s0_m + actor.speed_mps * static_cast<double>(frame) * options_.period_s;
    return s > 4 && s < street_.length_m() - 4;
}

SE3 World::T_world_obj(const Actor& actor, uint64_t frame) const {
    const double t = static_cast<double>(frame) * options_.period_s;
    SE3 T = street_.poseAt(actor.s0_m + actor.speed_mps * t, actor.lateral_m);
    if (actor.oncoming) T = T * SE3::fromYaw(M_PI, Vec3::Zero());
    return T * SE3(geometry::Mat3::Identity(), Vec3(0, 0, 0.5 * actor.size_m.z()));
}

uint32_t World::phase(const Actor&, uint64_t) const { return 0; }

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
