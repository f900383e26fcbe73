// Actors by number, and people on foot.
#include <algorithm>
#include <array>
#include <cmath>

#include "actor_body.h"
#include "noise.h"
#include "traffic.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

Spot spotOf(const SE3& T_world_plane, double way_m) {
    return {T_world_plane.translation().x(), T_world_plane.translation().y(),
            T_world_plane.yaw_rad(), static_cast<float>(way_m)};
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

uint32_t driveSeed(const WorldOptions& options) {
    return options.trafficSeed == 0 ? options.seed : hash(options.seed, 80U, options.trafficSeed);
}

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
    const BodyKind body = drawVehicle(hash(seed, 1U));
    return add(body.type, body.kind, seed);
}

void Population::remove(const std::vector<bool>& gone) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < actors.size(); ++i) {
        if (gone[i]) continue;
        if (kept != i) {
            actors[kept] = actors[i];
            tracks[kept] = std::move(tracks[i]);
        }
        actors[kept].id = static_cast<uint32_t>(kept) + 1;
        ++kept;
    }
    actors.resize(kept);
    tracks.resize(kept);
}

namespace {

/// Somebody who walks to and fro between two places of a street, turning on the spot at both.
Track walk(const Street& road, double from, double to, double lateral_m, double start,
           double speed_mps, double period_s, uint64_t frames) {
    constexpr double kTurn_m = 0.5;  // before and after the ends
    Track track;
    track.parked = false;
    const double length = to - from;
    for (uint64_t f = 0; f <= frames; ++f) {
        const double way = speed_mps * period_s * static_cast<double>(f);
        const double t = std::fmod(start + way, 2 * length);  // there, then back
        const bool returns = t > length;
        const double end = std::min(std::abs(t - length), std::min(t, 2 * length - t));
        const double half = 0.5 * std::max(0.0, 1.0 - end / kTurn_m);
        const bool before = returns ? t > 1.5 * length : t > 0.5 * length;
        const double turn = M_PI * ((returns ? 1.0 : 0.0) + (before ? half : -half));
        const SE3 T = road.poseAt(returns ? to - (t - length) : from + t, lateral_m) *
                      SE3::fromYaw(turn, Vec3::Zero());
        track.spots.push_back(spotOf(T, way));
    }
    return track;
}

}  // namespace

void addPedestrians(Population& population, const Network& network, const WorldOptions& options,
                    uint64_t frames) {
    constexpr double kStretch_m = 55, kMost = 150;
    // Side by side on the pavement; one for each, so that nobody walks through anybody.
    constexpr std::array<double, 2> kWalk_m{1.0, 2.05};
    constexpr double kStand_m = 2.05;
    double roads_m = 0;
    for (const auto& road : network.roads()) roads_m += road.length_m();
    const auto often = static_cast<float>(std::min(0.6, kMost * kStretch_m / (6 * roads_m)));
    for (uint32_t r = 0; r < network.roads().size(); ++r) {
        const Street& road = network.roads()[r];
        for (uint32_t side = 0; side < 2; ++side) {
            const double sign = side == 0 ? -1 : 1;
            uint32_t n = 0;
            for (const auto& [begin, end] :
                 pavements(network, road, sign * (kRoadHalfWidth_m + 1.5), 14)) {
                const double parts = std::ceil((end - begin) / kStretch_m);
                const double length = (end - begin) / parts;
                for (double from = begin; from < end - 1; from += length) {
                    const uint32_t h = hash(driveSeed(options), 600U + side + 2 * r, n++);
                    for (uint32_t k = 0; k < kWalk_m.size(); ++k) {
                        const uint32_t w = hash(h, 10U + k);
                        if (unit(w) > often) continue;
                        population.add(ActorType::Pedestrian, 0, hash(w, 1U)).moving = true;
                        population.tracks.back() =
                            walk(road, from + 0.9, from + length - 0.9,
                                 sign * (kRoadHalfWidth_m + kWalk_m[k]),
                                 static_cast<double>(unit(hash(w, 2U))) * 2 * (length - 1.8),
                                 static_cast<double>(between(hash(w, 3U), 1.0F, 1.6F)),
                                 options.period_s, frames);
                    }
                    const bool taken = unit(hash(h, 11U)) <= often;  // by one who walks there
                    if (taken || unit(hash(h, 20U)) > often) continue;
                    population.add(ActorType::Pedestrian, 0, hash(h, 21U));
                    const double at = static_cast<double>(between(hash(h, 22U), 1.F, 4.F));
                    const double turn = static_cast<double>(between(hash(h, 23U), -3.1F, 3.1F));
                    const SE3 T = road.poseAt(from + at, sign * (kRoadHalfWidth_m + kStand_m)) *
                                  SE3::fromYaw(turn, Vec3::Zero());
                    population.tracks.back().spots = {spotOf(T, 0)};
                }
            }
        }
    }
}

}  // namespace djpete::simulator
