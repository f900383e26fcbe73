#include "network.h"

#include <algorithm>
#include <cmath>

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

Network::Cell Network::cellOf(const Vec2& p) {
    return {static_cast<int>(std::floor(p.x() / kCell_m)),
            static_cast<int>(std::floor(p.y() / kCell_m))};
}

Network::Network(std::vector<Street> roads, Terrain terrain, const std::vector<Vec2>& route)
    : roads_(std::move(roads)), terrain_(std::move(terrain)) {
    constexpr double kSegment_m = 1.0;
    const int reach = static_cast<int>(std::ceil(kReach_m / kCell_m)) + 1;
    for (uint32_t r = 0; r < roads_.size(); ++r) {
        const double length = roads_[r].length_m();
        for (double s = 0; s < length - 1e-9; s += kSegment_m) {
            const Vec2 a = roads_[r].poseAt(s).translation().head<2>();
            const Vec2 b =
                roads_[r].poseAt(std::min(length, s + kSegment_m)).translation().head<2>();
            const double way = (b - a).norm();
            if (way < 1e-6) continue;
            const auto index = static_cast<uint32_t>(segments_.size());
            segments_.push_back({a, (b - a) / way, way, s, r});
            const Cell c = cellOf(0.5 * (a + b));
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x) {
                    const Vec2 middle(kCell_m * (c.first + x + 0.5),
                                      kCell_m * (c.second + y + 0.5));
                    if ((middle - a).norm() < kReach_m + kCell_m)
                        near_[{c.first + x, c.second + y}].push_back(index);
                }
        }
    }
    for (const auto& p : route) {
        const Cell c = cellOf(p);
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) route_[{c.first + x, c.second + y}].push_back(p);
    }
}

RoadPoint Network::nearest(const Vec2& p) const {
    RoadPoint best;
    const auto cell = near_.find(cellOf(p));
    if (cell == near_.end()) return best;
    double least = kReach_m * kReach_m, other = 1e6;
    double leastOfRoad = 1e6;
    uint32_t road = RoadPoint::kNone;
    const Segment* nearest = nullptr;
    const auto endRoad = [&] {  // the distance of the road just gone through
        if (road == RoadPoint::kNone || (nearest != nullptr && nearest->road == road)) return;
        other = std::min(other, leastOfRoad);
    };
    for (const uint32_t i : cell->second) {
        const Segment& g = segments_[i];
        if (g.road != road) {
            endRoad();
            road = g.road;
            leastOfRoad = 1e6;
        }
        const Vec2 d = p - g.from;
        const double along = std::clamp(d.dot(g.way), 0.0, g.length_m);
        const double d2 = (d - along * g.way).squaredNorm();
        leastOfRoad = std::min(leastOfRoad, d2);
        if (d2 >= least) continue;
        if (nearest != nullptr && nearest->road != road) other = std::min(other, least);
        least = d2;
        nearest = &g;
        best.s_m = g.s_m + along;
        best.lateral_m = g.way.x() * d.y() - g.way.y() * d.x();
    }
    endRoad();
    if (nearest == nullptr) return best;
    best.road = nearest->road;
    best.distance_m = std::sqrt(least);
    best.other_m = std::sqrt(other);
    return best;
}

double Network::edge_m(const RoadPoint& at) {
    constexpr double kRound_m = 5.0;
    const double h = std::max(0.0, kRound_m - (at.other_m - at.distance_m)) / kRound_m;
    return at.distance_m - 0.25 * kRound_m * h * h;
}

double Network::edge_m(const Vec2& p) const { return edge_m(nearest(p)); }

double Network::ground_m(const Vec2& p) const {
    return terrain_.height_m(p) + (edge_m(p) < kRoadHalfWidth_m ? 0.0 : kKerb_m);
}

double Network::routeDistance_m(const Vec2& p) const {
    double least = 64;
    const auto cell = route_.find(cellOf(p));
    if (cell == route_.end()) return 8;
    for (const auto& q : cell->second) least = std::min(least, (q - p).squaredNorm());
    return std::sqrt(least);
}

SE3 Network::placed(const SE3& T_world_plane, double length_m) const {
    const Vec2 p = T_world_plane.translation().head<2>();
    const Vec2 x = T_world_plane.rotation().col(0).head<2>();
    const Vec2 y = T_world_plane.rotation().col(1).head<2>();
    const double half = 0.4 * length_m;
    const auto h = [&](const Vec2& q) { return terrain_.height_m(q); };
    const double rise = (h(p + half * x) - h(p - half * x)) / (2 * half);
    const double side = h(p + 0.7 * y) - h(p - 0.7 * y);
    geometry::Mat3 axes;
    axes.col(0) = Vec3(x.x(), x.y(), rise).normalized();
    const Vec3 left = Vec3(y.x(), y.y(), side / 1.4);
    axes.col(2) = axes.col(0).cross(left).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return SE3(axes, Vec3(p.x(), p.y(), h(p)));
}

}  // namespace djpete::simulator
