// Streets around a way: those it leads through, and those that lead off.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "network.h"
#include "noise.h"
#include "route.h"

namespace djpete::simulator {
namespace {

using geometry::SE3;
using geometry::Vec2;

/// Points of centre lines, found again by place.
class Trace {
  public:
    struct Point {
        Vec2 p, heading;
        double s_m;
        std::size_t road;
    };
    void add(const Point& point) { cells_[cellOf(point.p)].push_back(point); }
    void addRoad(const Street& road, std::size_t index) {
        for (double s = 0; s <= road.length_m(); s += 1) {
            const SE3 T = road.poseAt(s);
            add({T.translation().head<2>(), T.rotation().col(0).head<2>(), s, index});
        }
    }
    /// Calls f with every point less than `reach_m` (up to kCell_m) away.
    template <class F>
    void around(const Vec2& p, double reach_m, F&& f) const {
        const auto c = cellOf(p);
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                const auto cell = cells_.find({c.first + x, c.second + y});
                if (cell == cells_.end()) continue;
                for (const auto& q : cell->second)
                    if ((q.p - p).squaredNorm() < reach_m * reach_m) f(q);
            }
        }
    }

  private:
    static constexpr double kCell_m = 24;
    static std::pair<int, int> cellOf(const Vec2& p) {
        return {static_cast<int>(std::floor(p.x() / kCell_m)),
                static_cast<int>(std::floor(p.y() / kCell_m))};
    }
    std::map<std::pair<int, int>, std::vector<Point>> cells_;
};

/// Straight on from a pose for at most `length_m`, to the street it meets, if any. Empty if it
/// would run beside another street.
std::vector<Vec2> straightOn(const SE3& T, double length_m, const Trace& trace, std::size_t own) {
    constexpr double kStep_m = 2, kClear_m = 21, kLeast_m = 40;
    const Vec2 start = T.translation().head<2>(), way = T.rotation().col(0).head<2>();
    std::vector<Vec2> line;
    for (double s = 0; s <= length_m; s += kStep_m) {
        const Vec2 p = start + s * way;
        bool beside = false, met = false;
        trace.around(p, kClear_m, [&](const Trace::Point& q) {
            if (q.road == own && s < 34) return;
            const bool across = std::abs(q.heading.dot(way)) < 0.6;
            if (!across) beside = true;
            if (across && (q.p - p).norm() < 1.5) met = true;
        });
        if (beside) {
            if (s < kLeast_m + kClear_m) return {};
            line.resize(line.size() - static_cast<std::size_t>(kClear_m / kStep_m));
            return line;
        }
        line.push_back(p);
        if (met && s > 20) return line;
    }
    return line;
}

}  // namespace

std::vector<Street> streetsAlong(const Street& path) {
    constexpr double kSame_m = 4.5, kBack_m = 40, kJoin_m = 9, kLeast_m = 18, kBeyond_m = 80;
    Trace trace;
    std::vector<std::pair<double, double>> runs;  // of new street, s from .. to
    double from = 0, newUntil = 0;
    bool running = true;
    const double length = path.length_m();
    const auto point = [&](double s) {
        const SE3 T = path.poseAt(s, kLane_m);
        return Trace::Point{T.translation().head<2>(), T.rotation().col(0).head<2>(), s, 0};
    };
    for (double s = 0; s <= length; s += 1) {
        const auto here = point(s);
        bool known = false;
        trace.around(here.p, kSame_m, [&](const Trace::Point& q) {
            known = known || (s - q.s_m > kBack_m && std::abs(q.heading.dot(here.heading)) > 0.82);
        });
        if (!known) {
            if (!running) from = s;
            running = true;
            newUntil = s;
            trace.add(here);
        } else if (running && s - newUntil > kJoin_m) {
            runs.emplace_back(from, newUntil);
            running = false;
        }
    }
    if (running) runs.emplace_back(from, newUntil);
    std::vector<Street> roads;
    for (const auto& [begin, end] : runs) {
        if (end - begin < kLeast_m) continue;
        std::vector<Vec2> line;
        const double first = begin <= 0 ? -kBeyond_m : begin - kJoin_m;
        const double last = end >= length - 2 ? end + kBeyond_m : end + kJoin_m;
        for (double s = first; s <= last; s += 1)
            line.emplace_back(path.poseAt(s, kLane_m).translation().head<2>());
        roads.emplace_back(line, 2.0);
    }
    return roads;
}

void addSideStreets(std::vector<Street>& roads, std::size_t own, uint32_t seed) {
    constexpr double kTurn_rad = 0.9, kAround_m = 14;
    Trace trace;
    for (std::size_t r = 0; r < roads.size(); ++r) trace.addRoad(roads[r], r);
    const auto lead = [&](const SE3& T, double length_m, std::size_t from) {
        const auto line = straightOn(T, length_m, trace, from);
        if (line.size() < 20) return;
        roads.emplace_back(line, 1.0);
        trace.addRoad(roads.back(), roads.size() - 1);
    };
    for (std::size_t r = 0; r < own; ++r) {
        const Street road = roads[r];  // a copy: the list grows
        double free = 34;              // no street leads off before it
        uint32_t n = 0;
        const auto headingAt = [&](double s) { return road.poseAt(s).yaw_rad(); };
        for (double s = kAround_m; s < road.length_m() - 25; s += 1) {
            const double turn =
                std::remainder(headingAt(s + kAround_m) - headingAt(s - kAround_m), 2 * M_PI);
            if (std::abs(turn) > kTurn_rad) {  // the street turns off: another goes straight on
                lead(road.poseAt(s - kAround_m + 2), 90, r);
                s += 2 * kAround_m;
                free = s + 25;
                continue;
            }
            if (s < free) continue;
            const uint32_t h = hash(seed, 80U + static_cast<uint32_t>(r), n++);
            free = s + static_cast<double>(between(hash(h, 1U), 55.F, 110.F));
            const auto quarter = [&](double sign) {
                return road.poseAt(s) * SE3::fromYaw(0.5 * M_PI * sign, geometry::Vec3::Zero());
            };
            const double side = unit(hash(h, 2U)) < 0.5F ? -1.0 : 1.0;
            const bool straight = std::abs(turn) < 0.25;
            if (!straight) continue;
            lead(quarter(side), 110, r);
            if (unit(hash(h, 3U)) < 0.35F) lead(quarter(-side), 110, r);
        }
    }
}

}  // namespace djpete::simulator
