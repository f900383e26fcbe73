// The convoy on its way, and the room it needs.
#include <algorithm>
#include <cmath>

#include "boxes.h"
#include "convoy.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

using geometry::SE3;
using geometry::Vec3;

SE3 poseOf(const Spot& q) { return SE3::fromYaw(q.yaw_rad, Vec3(q.x_m, q.y_m, 0)); }

/// Marks everybody of a range of actors whom one on a track would touch.
void markTouched(const Population& population, const Track& track, const Vec3& size,
                 std::size_t begin, std::size_t end, uint64_t frames, std::vector<bool>& gone) {
    constexpr double kRoom_m = 0.25, kFar_m = 10;
    for (uint64_t f = track.first; f <= frames && track.has(f); ++f) {
        const SE3 T = poseOf(track.at(f));
        for (std::size_t k = begin; k < end; ++k) {
            if (gone[k] || !population.tracks[k].has(f)) continue;
            const Spot& q = population.tracks[k].at(f);
            if (std::hypot(q.x_m - T.translation().x(), q.y_m - T.translation().y()) > kFar_m)
                continue;
            if (gapBetween(T, size, poseOf(q), population.actors[k].size_m) < kRoom_m)
                gone[k] = true;
        }
    }
}

}  // namespace

std::vector<std::size_t> addConvoy(Population& population, const std::vector<ConvoyPlace>& places,
                                   const Route& route, const WorldOptions& options) {
    std::vector<double> own_m;  // finer than the route's arc lengths
    for (std::size_t f = 0; f < route.path_m.size(); ++f) {
        const SE3 T = route.path.poseAt(route.path_m[f]);
        const Vec3 beside = route.T_world_vehicle[f].translation() - T.translation();
        own_m.push_back(route.path_m[f] + T.rotation().col(0).dot(beside));
    }
    std::vector<std::size_t> out;
    for (uint32_t k = 0; k < places.size(); ++k) {
        const ConvoyPlace& place = places[k];
        const double phase =
            static_cast<double>(between(hash(driveSeed(options), 445U, k), 0.F, 6.28F));
        population.add(place.type, place.kind, place.seed).moving = true;
        Track& track = population.tracks.back();
        track.parked = false;
        double way = 0;
        for (std::size_t f = 0; f < own_m.size(); ++f) {
            const double t = static_cast<double>(f) * options.period_s;
            const double ahead = place.ahead_m + 0.4 * std::sin(phase + t / 3.0);
            const double left = place.left_m + 0.06 * std::sin(phase + t / 2.3);
            const SE3 T = route.path.poseAt(own_m[f] + ahead, left);
            const Vec3& p = T.translation();
            if (f > 0)
                way += std::hypot(p.x() - track.spots.back().x_m, p.y() - track.spots.back().y_m);
            track.spots.push_back({p.x(), p.y(), T.yaw_rad(), static_cast<float>(way)});
        }
        out.push_back(population.actors.size() - 1);
    }
    return out;
}

void clearTheWay(Population& population, const Route& route, std::size_t drivers,
                 const std::vector<std::size_t>& convoy, const std::vector<std::size_t>& oncoming) {
    const std::size_t all = population.actors.size();
    std::vector<bool> gone(all, false);
    const auto mark = [&](std::size_t i, std::size_t begin, std::size_t end) {
        markTouched(population, population.tracks[i], population.actors[i].size_m, begin, end,
                    route.frames, gone);
    };
    for (std::size_t i : convoy) {
        mark(i, 0, convoy.front());
        mark(i, drivers, all);
    }
    for (std::size_t i : oncoming)
        if (!gone[i]) mark(i, 0, convoy.front());
    // Who drives keeps clear of others, but for close calls where their ways cross.
    Track own;
    own.parked = false;
    for (const SE3& T : route.T_world_vehicle)
        own.spots.push_back({T.translation().x(), T.translation().y(), T.yaw_rad(), 0});
    markTouched(population, own, Vec3(4.4, 1.8, 1.5), drivers, all, route.frames, gone);
    for (std::size_t i = drivers; i < all; ++i)
        if (!gone[i]) mark(i, i + 1, all);
    population.remove(gone);
}

}  // namespace djpete::simulator
