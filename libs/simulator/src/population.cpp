// Parked cars and people on foot.
#include <algorithm>
#include <cmath>

#include "actor_body.h"
#include "noise.h"
#include "traffic.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

constexpr double kParking_m = 4.25;  // from the centre line

Spot spotOf(const SE3& T_world_plane, double way_m) {
    return {T_world_plane.translation().x(), T_world_plane.translation().y(),
            T_world_plane.yaw_rad(), static_cast<float>(way_m)};
}

/// True if a parked car would stand in nobody's way.
bool mayPark(const Network& network, const SE3& T, const Vec3& size_m,
             const std::vector<Vec2>& parked) {
    constexpr double kJunction_m = 11.0, kOwnHalfWidth_m = 1.0, kApart_m = 3.2;
    for (double u = -0.5; u <= 0.51; u += 0.25) {
        for (double v : {-0.5, 0.0, 0.5}) {
            const Vec3 p = T * Vec3(u * size_m.x(), v * size_m.y(), 0);
            const Vec2 q = p.head<2>();
            if (network.routeDistance_m(q) < kOwnHalfWidth_m + 0.35) return false;
            if (network.nearest(q).other_m < kJunction_m) return false;
        }
    }
    const Vec2 c = T.translation().head<2>();
    return std::none_of(parked.begin(), parked.end(),
                        [&](const Vec2& p) { return (p - c).norm() < kApart_m; });
}

/// Stretches of pavement beside a street without a street in between: s from .. to.
std::vector<std::pair<double, double>> pavements(const Network& network, const Street& road,
                                                 double lateral_m, double least_m) {
    std::vector<std::pair<double, double>> out;
    double from = 4;
    for (double s = 4; s <= road.length_m() - 4; s += 1) {
        const Vec2 p = road.poseAt(s, lateral_m).translation().head<2>();
        const bool end = s + 1 > road.length_m() - 4;
        if (!end && network.edge_m(p) > kRoadHalfWidth_m + 0.5 && network.routeDistance_m(p) > 2)
            continue;
        if (s - from > least_m) out.emplace_back(from, s - 1);
        from = s + 1;
    }
    return out;
}

}  // namespace

Actor& Population::add(ActorType type, uint32_t kind, uint32_t seed) {
    Actor actor;
    actor.id = static_cast<uint32_t>(actors.size()) + 1;
    actor.type = type;
    actor.kind = kind;
    actor.seed = seed;
    actor.size_m = bodySize(actor);
    actors.push_back(actor);
    tracks.emplace_back();
    return actors.back();
}

Actor& Population::addVehicle(uint32_t seed) {
    const BodyKind body = kVehicleBodies[hash(seed, 1U) % kVehicleBodies.size()];
    return add(body.type, body.kind, seed);
}

void parkCars(Population& population, const Network& network, uint32_t seed) {
    // Masks and labels can tell 999 actors apart: half of them may be parked ones.
    constexpr double kMost = 500, kPitch_m = 8.5;
    double kerbs_m = 0;
    for (const auto& road : network.roads()) kerbs_m += 2 * road.length_m();
    const auto gaps =
        static_cast<float>(std::max(0.42, 1.0 - kMost / std::max(1.0, kerbs_m / kPitch_m)));
    std::vector<Vec2> parked;
    for (uint32_t r = 0; r < network.roads().size(); ++r) {
        const Street& road = network.roads()[r];
        double s[2] = {5, 5};
        uint32_t n[2] = {0, 0};
        while (std::min(s[0], s[1]) < road.length_m() - 8) {
            const std::size_t side = s[0] <= s[1] ? 0 : 1;
            const uint32_t h = hash(seed, 400U + static_cast<uint32_t>(side) + 2 * r, n[side]++);
            if (unit(h) < gaps) {
                s[side] += static_cast<double>(between(hash(h, 1U), 3.F, 12.F));
                continue;
            }
            Actor& car = population.addVehicle(hash(h, 5U));
            const bool against = (side == 1) != (unit(hash(h, 4U)) < 0.12F);
            const double lateral =
                (side == 0 ? -1 : 1) *
                (kParking_m + static_cast<double>(between(hash(h, 2U), -0.12F, 0.12F)) -
                 0.5 * std::max(0.0, car.size_m.y() - 1.95));
            const double askew = static_cast<double>(between(hash(h, 6U), -0.03F, 0.03F));
            const SE3 T = road.poseAt(s[side] + 0.5 * car.size_m.x(), lateral) *
                          SE3::fromYaw((against ? M_PI : 0.0) + askew, Vec3::Zero());
            s[side] += car.size_m.x() + static_cast<double>(between(hash(h, 3U), 1.0F, 3.4F));
            if (!mayPark(network, T, car.size_m, parked)) {
                population.actors.pop_back();
                population.tracks.pop_back();
                continue;
            }
            parked.emplace_back(T.translation().head<2>());
            population.tracks.back().spots = {spotOf(T, 0)};
        }
    }
}

void addPedestrians(Population& population, const Network& network, const WorldOptions& options,
                    uint64_t frames) {
    constexpr double kTurn_m = 0.5, kMost = 160;
    double roads_m = 0;
    for (const auto& road : network.roads()) roads_m += road.length_m();
    const auto spacing = static_cast<float>(std::max(1.0, 2 * roads_m / 34.0 / kMost));
    for (uint32_t r = 0; r < network.roads().size(); ++r) {
        const Street& road = network.roads()[r];
        for (uint32_t side = 0; side < 2; ++side) {
            const double sign = side == 0 ? -1 : 1;
            uint32_t n = 0;
            for (const auto& [from, to] :
                 pavements(network, road, sign * (kRoadHalfWidth_m + 1.6), 14)) {
                for (double at = from;;) {
                    const uint32_t h = hash(options.seed, 600U + side + 2 * r, n++);
                    at += static_cast<double>(between(h, 10.F, 58.F) * spacing);
                    if (at > to) break;
                    const double lateral =
                        sign *
                        (kRoadHalfWidth_m + static_cast<double>(between(hash(h, 1U), 1.25F, 2.1F)));
                    const bool stands = unit(hash(h, 2U)) < 0.2F;
                    const double speed =
                        stands ? 0.0 : static_cast<double>(between(hash(h, 3U), 1.0F, 1.6F));
                    const bool back = unit(hash(h, 4U)) < 0.5F;
                    const double length = to - from;
                    Actor& actor = population.add(ActorType::Pedestrian, 0, hash(h, 5U));
                    actor.moving = !stands;
                    Track& track = population.tracks.back();
                    if (stands) {
                        const double turn = static_cast<double>(between(hash(h, 6U), -3.1F, 3.1F));
                        track.spots = {
                            spotOf(road.poseAt(at, lateral) * SE3::fromYaw(turn, Vec3::Zero()), 0)};
                        continue;
                    }
                    track.parked = false;
                    for (uint64_t f = 0; f <= frames; ++f) {
                        const double way = speed * options.period_s * static_cast<double>(f);
                        // There (0 .. length) and back (length .. 2 * length), round and round.
                        double t = std::fmod((back ? 2 * length - (at - from) : at - from) + way,
                                             2 * length);
                        const bool returns = t > length;
                        const double s = returns ? to - (t - length) : from + t;
                        // Turns on the spot at the ends, over kTurn_m before and after them.
                        const double end =
                            std::min(std::abs(t - length), std::min(t, 2 * length - t));
                        const double half = 0.5 * std::max(0.0, 1.0 - end / kTurn_m);
                        const bool before = returns ? t > 1.5 * length : t > 0.5 * length;
                        const double turned = before ? half : -half;
                        const SE3 T =
                            road.poseAt(s, lateral) *
                            SE3::fromYaw((returns ? M_PI : 0.0) + M_PI * turned, Vec3::Zero());
                        track.spots.push_back(spotOf(T, way));
                    }
                }
            }
        }
    }
}

}  // namespace djpete::simulator
