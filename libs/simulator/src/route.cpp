#include "route.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "network.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kVeloHeight_m = 1.73;
constexpr double kStart_m = 8.0;     // own vehicle at frame 0
constexpr double kBlock_m = 1000.0;  // the district grows in such steps
constexpr uint64_t kOutlook = 100;   // frames after the last one, for those who look ahead

/// A little pitch, roll and bounce on top of a pose on the ground.
SE3 onWheels(const SE3& T_world_ground, double frame, double yaw_rad) {
    geometry::Vec6 sway;
    sway << 0, 0, kVeloHeight_m + 0.012 * std::sin(frame / 2.3), 0.003 * std::sin(frame / 5.1),
        0.004 * std::sin(frame / 3.7), yaw_rad;
    return T_world_ground * SE3::exp(sway);
}

/// Arc length on the path next to each frame's position.
std::vector<double> followed(const Street& path, const std::vector<SE3>& T_world_vehicle) {
    std::vector<double> out;
    double s = 0;
    for (const auto& T : T_world_vehicle) {
        const auto off = [&](double at) {
            return (path.poseAt(at).translation() - T.translation()).head<2>().squaredNorm();
        };
        for (double best = off(s);;) {
            const double next = off(s + 0.1);
            if (next >= best) break;
            best = next;
            s += 0.1;
        }
        out.push_back(s);
    }
    return out;
}

/// A gently bending street.
Route alongStreet(const WorldOptions& o) {
    constexpr double kView_m = 200.0;
    const double needed = kStart_m + static_cast<double>(o.frames) * o.step_m + kView_m;
    const Street street(kBlock_m * std::ceil(needed / kBlock_m), o.seed);
    Route route;
    for (uint64_t f = 0; f <= o.frames + kOutlook; ++f) {
        const auto t = static_cast<double>(f);
        const SE3 T = street.poseAt(kStart_m + t * o.step_m, -kLane_m + 0.1 * std::sin(t / 17.0));
        route.T_world_vehicle.push_back(onWheels(T, t, 0.1 / 17.0 / o.step_m * std::cos(t / 17.0)));
    }
    std::vector<Vec2> line;
    for (double s = 0; s < street.length_m(); s += 1)
        line.emplace_back(street.poseAt(s, -kLane_m).translation().head<2>());
    route.path = Street(line, 1.0);
    route.roads = {street};
    addSideStreets(route.roads, 1, o.seed);
    return route;
}

/// The polyline in the right-hand lane from node to node, corners rounded.
std::vector<Vec2> laneThrough(const std::vector<Vec2>& nodes) {
    std::vector<Vec2> out;
    const auto direction = [&](std::size_t i) -> Vec2 {
        return (nodes[i + 1] - nodes[i]).normalized();
    };
    const auto rightOf = [](const Vec2& d) { return Vec2(d.y(), -d.x()); };
    out.push_back(nodes[0] + kLane_m * rightOf(direction(0)));
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
        const Vec2 a = direction(i - 1), b = direction(i);
        const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
        if (std::abs(turn) < 0.01) {
            out.push_back(nodes[i] + kLane_m * rightOf(a));
            continue;
        }
        const Vec2 corner =
            nodes[i] + kLane_m * (rightOf(a) + std::tan(0.5 * turn) * a);  // of the offset lines
        const double radius = turn > 0 ? 10.0 : 6.5, cut = radius * std::tan(0.5 * std::abs(turn));
        const Vec2 left = (turn > 0 ? -1.0 : 1.0) * rightOf(a);
        const Vec2 centre = corner - cut * a + radius * left;
        for (int k = 0; k <= 12; ++k) {
            const double angle = std::abs(turn) * k / 12.0;
            out.push_back(centre + radius * (std::sin(angle) * a - std::cos(angle) * left));
        }
    }
    out.push_back(nodes.back() + kLane_m * rightOf(direction(nodes.size() - 2)));
    return out;
}

/// Round one block, then round two, again and again: 2 x 1 blocks of a grid of streets.
Route aroundBlocks(const WorldOptions& o) {
    const double wide = static_cast<double>(between(hash(o.seed, 70U), 74.F, 88.F));
    const double deep = static_cast<double>(between(hash(o.seed, 71U), 60.F, 70.F));
    constexpr double kBeyond_m = 75;
    Route route;
    const auto node = [&](int x, int y) { return Vec2(x * wide, y * deep); };
    const auto straight = [&](const Vec2& a, const Vec2& b) {
        std::vector<Vec2> line;
        const auto n = static_cast<int>((b - a).norm() / 2.0);
        for (int i = 0; i <= n; ++i) line.emplace_back(a + (b - a) * i / n);
        route.roads.emplace_back(line, 1.0);
    };
    for (int y = 0; y < 2; ++y)
        straight(node(0, y) - Vec2(kBeyond_m, 0), node(2, y) + Vec2(kBeyond_m, 0));
    for (int x = 0; x < 3; ++x)
        straight(node(x, 0) - Vec2(0, kBeyond_m), node(x, 1) + Vec2(0, kBeyond_m));
    static constexpr std::array<std::array<int, 2>, 10> kLaps{
        {{1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}, {0, 0}}};
    const double needed =
        kBlock_m * std::ceil((static_cast<double>(o.frames) * o.step_m + 250.0) / kBlock_m);
    std::vector<Vec2> nodes{node(0, 0) + Vec2(kStart_m, 0)};
    double length = 0;
    for (std::size_t i = 0; length < needed; ++i) {
        const auto& next = kLaps[i % kLaps.size()];
        nodes.push_back(node(next[0], next[1]));
        length += (nodes[nodes.size() - 1] - nodes[nodes.size() - 2]).norm() - 10.0;
    }
    route.path = Street(laneThrough(nodes), 1.5);
    const auto speed = [&](double s) {  // slower in bends, before them and after them
        double sum = 0;
        for (int k = -4; k <= 4; ++k) {
            const double bend = std::abs(route.path.curvatureAt(s + 1.5 * k));
            sum += std::clamp(std::sqrt(0.02 / std::max(bend, 1e-6)), 0.42, 1.0);
        }
        return o.step_m * sum / 9.0;
    };
    double s = 0;
    for (uint64_t f = 0; f <= o.frames + kOutlook; ++f) {
        const double wave = s / 14.0;
        route.T_world_vehicle.push_back(onWheels(route.path.poseAt(s, 0.1 * std::sin(wave)),
                                                 static_cast<double>(f),
                                                 0.1 / 14.0 * std::cos(wave)));
        s += speed(s);
    }
    return route;
}

/// Upright world around recorded camera poses; the own vehicle stands on the terrain.
Route alongPoses(const WorldOptions& o) {
    const auto& poses = o.T_first_cam;
    Vec3 up(0, 0, 0), low = poses.front().translation(), high = low;
    for (const auto& T : poses) {
        up -= T.rotation().col(1);
        low = low.cwiseMin(T.translation());
        high = high.cwiseMax(T.translation());
    }
    if (poses.size() < 2 || (high - low).norm() < 1.0)
        throw std::runtime_error(
            "The poses lead nowhere: expected a way of at least a metre, got " +
            std::to_string(poses.size()) + " poses");
    up.normalize();
    geometry::Mat3 R_first_world;  // axes of the world seen from the first camera
    R_first_world.col(2) = up;
    const Vec3 ahead = poses.front().rotation().col(2);
    R_first_world.col(0) = (ahead - ahead.dot(up) * up).normalized();
    R_first_world.col(1) = up.cross(R_first_world.col(0));
    const SE3 T_cam_vehicle = T_vehicle_camera().inverse();
    SE3 T_world_first(R_first_world.transpose(), Vec3::Zero());
    const Vec3 start = (T_world_first * poses.front() * T_cam_vehicle).translation();
    T_world_first = SE3(R_first_world.transpose(), Vec3(0, 0, kVeloHeight_m) - start);
    Route route;
    std::vector<Vec3> ground;
    std::vector<Vec2> line;
    for (const auto& T_first_cam : poses) {
        route.T_world_vehicle.push_back(T_world_first * T_first_cam * T_cam_vehicle);
        const Vec3 p = route.T_world_vehicle.back().translation();
        ground.emplace_back(p.x(), p.y(), p.z() - kVeloHeight_m);
        if (line.empty() || (p.head<2>() - line.back()).norm() > 0.3)
            line.emplace_back(p.head<2>());
    }
    route.terrain = Terrain(ground);
    for (auto& T : route.T_world_vehicle) {
        Vec3 p = T.translation();
        p.z() = route.terrain.height_m(p.head<2>()) + kVeloHeight_m;
        T = SE3(T.rotation(), p);
    }
    route.path = Street(line, 1.5);
    route.roads = streetsAlong(route.path);
    addSideStreets(route.roads, route.roads.size(), o.seed);
    return route;
}

/// Moves the own vehicle to the left, on the ground there.
void keepToTheSide(Route& route, double left_m) {
    for (auto& T : route.T_world_vehicle) {
        const double yaw = T.yaw_rad();
        const Vec2 before = T.translation().head<2>();
        const Vec2 after = before + left_m * Vec2(-std::sin(yaw), std::cos(yaw));
        const double climb = route.terrain.height_m(after) - route.terrain.height_m(before);
        T = SE3(T.rotation(), Vec3(after.x(), after.y(), T.translation().z() + climb));
    }
}

}  // namespace

Route makeRoute(const WorldOptions& options) {
    Route route = !options.T_first_cam.empty()         ? alongPoses(options)
                  : options.route == RouteKind::Blocks ? aroundBlocks(options)
                                                       : alongStreet(options);
    route.frames = options.T_first_cam.empty() ? options.frames : options.T_first_cam.size();
    route.path_m = followed(route.path, route.T_world_vehicle);
    route.T_world_start = route.T_world_vehicle.front();
    if (options.laneOffset_m != 0) keepToTheSide(route, options.laneOffset_m);
    return route;
}

}  // namespace djpete::simulator
