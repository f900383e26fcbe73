/// The way of the own vehicle and the streets it leads through.
#pragma once

#include <vector>

#include "djpete/simulator/world.h"
#include "terrain.h"

namespace djpete::simulator {

struct Route {
    std::vector<Street> roads;  ///< centre lines
    Terrain terrain;
    uint64_t frames = 0;
    std::vector<geometry::SE3> T_world_vehicle;  ///< of every frame, and some more after the last
    geometry::SE3 T_world_start;                 ///< of frame 0 without WorldOptions::laneOffset_m
    Street path{1.0, 0};                         ///< where the own vehicle goes, and on
    std::vector<double> path_m;                  ///< arc length on it at every frame
};

/// By WorldOptions::route. Throws std::runtime_error if given poses are too few to drive along.
Route makeRoute(const WorldOptions& options);

/// The streets a recorded way leads through: its centre line is half a lane to the left of it, and
/// where it comes back to a street it has been to there is one street.
std::vector<Street> streetsAlong(const Street& path);

/// Adds streets that lead off the first `own` ones to both sides, and straight on where those turn;
/// they end where they meet another street, or after some way.
void addSideStreets(std::vector<Street>& roads, std::size_t own, uint32_t seed);

}  // namespace djpete::simulator
