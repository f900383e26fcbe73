/// The streets of a district and where things may stand.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "djpete/simulator/street.h"
#include "terrain.h"

namespace djpete::simulator {

constexpr double kRoadHalfWidth_m = 5.3;
constexpr double kKerb_m = 0.12;  // height of the pavements above the road
constexpr double kPavement_m = 2.6;
constexpr double kLane_m = 1.6;  // middle of the right-hand lane, to the right of the centre line

/// A point of the plane in the terms of the street next to it.
struct RoadPoint {
    static constexpr uint32_t kNone = 0xFFFFFFFFU;
    uint32_t road = kNone;  ///< kNone: farther than Network::kReach_m from all
    double s_m = 0, lateral_m = 0;
    double distance_m = 1e3;  ///< from the centre line
    double other_m = 1e3;     ///< from the nearest centre line of another street
};

/// Centre lines of streets, the ground's height, and the way of the own vehicle.
class Network {
  public:
    static constexpr double kReach_m = 44.0;

    /// `route`: positions of those who drive along, less than a metre apart.
    Network(std::vector<Street> roads, Terrain terrain, const std::vector<geometry::Vec2>& route);

    const std::vector<Street>& roads() const { return roads_; }
    const Terrain& terrain() const { return terrain_; }

    RoadPoint nearest(const geometry::Vec2& p) const;
    /// Distance from the centre lines, rounded off where streets meet: road where it is below
    /// kRoadHalfWidth_m, pavement up to kPavement_m more.
    double edge_m(const geometry::Vec2& p) const;
    static double edge_m(const RoadPoint& at);
    /// Height of the road or of the pavement.
    double ground_m(const geometry::Vec2& p) const;
    /// Distance from the middle of the own vehicle's way and of the lane beside it, at most 8 m.
    double routeDistance_m(const geometry::Vec2& p) const;
    /// The pose above, on the ground, leaning as the terrain does over `length_m`.
    geometry::SE3 placed(const geometry::SE3& T_world_plane, double length_m) const;

  private:
    struct Segment {
        geometry::Vec2 from, way;
        double length_m, s_m;
        uint32_t road;
    };
    using Cell = std::pair<int, int>;
    static constexpr double kCell_m = 8.0;
    static Cell cellOf(const geometry::Vec2& p);

    std::vector<Street> roads_;
    Terrain terrain_;
    std::vector<Segment> segments_;
    std::map<Cell, std::vector<uint32_t>> near_;  // segments within kReach_m of a cell, by road
    std::map<Cell, std::vector<geometry::Vec2>> route_;
};

}  // namespace djpete::simulator
