#include "djpete/simulator/world.h"

#include <algorithm>
#include <cmath>

#include "actor_body.h"
#include "network.h"
#include "route.h"
#include "traffic.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec3;

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
    : options_(options), route_(std::make_unique<const Route>(makeRoute(options))) {
    std::vector<geometry::Vec2> way;
    for (double s = -60; s <= route_->path.length_m() + 60; s += 0.5) {
        // Both lanes; both ends of a vehicle stick out in bends.
        for (double lateral : {0.0, 2 * kLane_m}) {
            for (double overhang : {0.0, 2.4, -2.4}) {
                const Vec3 p = route_->path.poseAt(s, lateral) * Vec3(overhang, 0, 0);
                way.emplace_back(p.head<2>());
            }
        }
    }
    network_ = std::make_unique<const Network>(route_->roads, route_->terrain, way);
    Population population;
    parkCars(population, *network_, *route_, options);
    addPedestrians(population, *network_, options, frames());
    addTraffic(population, *network_, *route_, options);
    actors_ = std::move(population.actors);
    tracks_ = std::move(population.tracks);
}

World::~World() = default;

uint64_t World::frames() const { return route_->frames; }

bool World::present(const Actor& actor, uint64_t frame) const {
    return tracks_.at(actor.id - 1).has(frame);
}

SE3 World::T_world_obj(const Actor& actor, uint64_t frame) const {
    const Spot& at = tracks_.at(actor.id - 1).at(frame);
    const geometry::Vec2 p(at.x_m, at.y_m);
    SE3 T_world_foot = SE3::fromYaw(at.yaw_rad, Vec3(p.x(), p.y(), 0));
    if (actor.type == ActorType::Pedestrian)
        T_world_foot = SE3(T_world_foot.rotation(), Vec3(p.x(), p.y(), network_->ground_m(p)));
    else
        T_world_foot = network_->placed(T_world_foot, actor.size_m.x());
    return T_world_foot * SE3(geometry::Mat3::Identity(), Vec3(0, 0, 0.5 * actor.size_m.z()));
}

uint32_t World::phase(const Actor& actor, uint64_t frame) const {
    const uint32_t phases = phasesOf(actor.type);
    if (phases == 1) return 0;
    const float stride = actor.type == ActorType::Pedestrian ? kDoubleStep_m : kPedalTurn_m;
    const float steps = tracks_.at(actor.id - 1).at(frame).way_m / stride;
    return static_cast<uint32_t>((steps - std::floor(steps)) * static_cast<float>(phases)) % phases;
}

SE3 World::T_world_vehicle(uint64_t frame) const {
    const auto& all = route_->T_world_vehicle;
    return all[std::min<std::size_t>(frame, all.size() - 1)];
}

const SE3& World::T_world_start() const { return route_->T_world_start; }

uint32_t World::driveSeed() const { return simulator::driveSeed(options_); }

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
