#include "traffic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "actor_body.h"
#include "convoy.h"
#include "noise.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

constexpr double kOwnLength_m = 4.4, kOwnHalfWidth_m = 0.9;

double smooth(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double between(uint32_t h, double from, double to) {
    return from + (to - from) * static_cast<double>(unit(h));
}

/// Somebody who drives along a path of its own.
struct Driver {
    std::size_t actor = 0;
    const Street* path = nullptr;
    double lateral_m = 0;
    double along = 1;  ///< -1: against the path's direction
    double s_m = 0, speed_mps = 0, free_mps = 8, way_m = 0;
    double half_m = 2.2, halfWidth_m = 0.9;
    bool cyclist = false;
    SE3 T;  ///< on the plane

    SE3 poseAhead(double ahead_m) const {
        const SE3 on = path->poseAt(s_m + along * ahead_m, along * lateral_m);
        return along > 0 ? on : on * SE3::fromYaw(M_PI, Vec3::Zero());
    }
    bool atEnd() const { return along > 0 ? s_m > path->length_m() - 3 : s_m < 3; }
};

/// What a driver has to keep clear of: discs along a body, now or soon.
struct Obstacle {
    std::array<Vec2, 3> discs;
    Vec2 heading;
    double radius_m;
    std::size_t driver;  // kOwn: the own vehicle or its escort
    bool cyclist, soon;
};
constexpr std::size_t kOwn = static_cast<std::size_t>(-1);

Obstacle obstacleAt(const SE3& T, double half_m, double halfWidth_m, std::size_t driver,
                    bool cyclist, bool soon) {
    const Vec2 c = T.translation().head<2>(), x = T.rotation().col(0).head<2>();
    const double reach = half_m - halfWidth_m;
    return {{c - reach * x, c, c + reach * x}, x, halfWidth_m, driver, cyclist, soon};
}

class Traffic {
  public:
    Traffic(Population& population, const Network& network, const Route& route,
            const WorldOptions& options)
        : population_(population),
          network_(network),
          route_(route),
          options_(options),
          seed_(driveSeed(options)) {
        for (std::size_t f = 0; f < route.T_world_vehicle.size(); ++f) {
            own_.push_back(flat(route.T_world_vehicle[f]));
            ownSpeed_.push_back(
                f == 0 ? 0.0 : (route.path_m[f] - route.path_m[f - 1]) / options.period_s);
        }
        if (ownSpeed_.size() > 1) ownSpeed_[0] = ownSpeed_[1];
        convoy_ = planConvoy(route, options);
        makePaths();
    }

    void run() {
        if (convoy_.empty())
            escort();
        else
            escorts_ = addConvoy(population_, convoy_, route_, options_);
        for (frame_ = 0; frame_ <= route_.frames; ++frame_) {
            if (frame_ == 0) spawnOncoming();
            for (std::size_t i = 0; i < entries_.size(); ++i) spawnFrom(i);
            step();
        }
        const bool asEver = options_.trafficSeed == 0 && options_.laneOffset_m == 0;
        if (convoy_.empty() && asEver) return;
        if (!leftTaken_) oncomers_.clear();  // they drive where nobody parks
        const std::size_t drivers = escorts_.back() + 1;
        if (convoy_.empty()) escorts_.clear();
        clearTheWay(population_, route_, drivers, escorts_, oncomers_);
    }

  private:
    /// A place where cars come into the streets now and then.
    struct Entry {
        Street path;
        double speed_mps;
        uint32_t seed, count = 0;
        double next_s = 0;
    };

    static SE3 flat(const SE3& T) {
        return SE3::fromYaw(T.yaw_rad(), Vec3(T.translation().x(), T.translation().y(), 0));
    }

    void makePaths() {
        // Those who come towards a convoy of two lanes keep to their kerb.
        constexpr double kAtTheKerb_m = 5.8;
        leftTaken_ = convoy_.size() > 1;
        oncoming_ = Street(linePoints(route_.path, 0, route_.path.length_m(),
                                      leftTaken_ ? kAtTheKerb_m : 2 * kLane_m),
                           1.5);
        for (uint32_t r = 0; r < network_.roads().size(); ++r) {
            const Street& road = network_.roads()[r];
            const bool crossing =
                options_.route == RouteKind::Blocks && options_.T_first_cam.empty();
            if (crossing) {
                addEntry(linePoints(road, 0, road.length_m(), -kLane_m), r, 0);
                addEntry(linePoints(road, road.length_m(), 0, kLane_m), r, 1);
            } else {
                turnIn(road, r);
            }
        }
    }

    /// Points beside a centre line from one arc length to another, either way.
    static std::vector<Vec2> linePoints(const Street& road, double from, double to,
                                        double lateral_m) {
        std::vector<Vec2> out;
        const double sign = from < to ? 1 : -1;
        for (double s = from; sign * (to - s) >= 0; s += sign)
            out.emplace_back(road.poseAt(s, lateral_m).translation().head<2>());
        return out;
    }

    void addEntry(const std::vector<Vec2>& points, uint32_t road, uint32_t way) {
        const uint32_t h = hash(seed_, 420U + way, road);
        Entry e{Street(points, 2.0), between(hash(h, 1U), 6.0, 9.0), h};
        e.next_s = between(hash(h, 2U), 0.0, 14.0);
        entries_.push_back(std::move(e));
    }

    /// From a side street to the right into the street it comes from.
    void turnIn(const Street& side, uint32_t r) {
        const SE3 mouth = side.poseAt(0);
        for (uint32_t q = 0; q < r; ++q) {
            const Street& main = network_.roads()[q];
            for (double s = 10; s < main.length_m() - 60; s += 1) {
                const SE3 T = main.poseAt(s);
                if ((T.translation() - mouth.translation()).norm() > 1.0) continue;
                const double across = T.rotation().col(0).dot(mouth.rotation().col(0));
                if (std::abs(across) > 0.5) continue;
                // A side street to the left of the main one comes out against its direction.
                const bool left = T.rotation().col(1).dot(mouth.rotation().col(0)) > 0;
                auto line = linePoints(side, side.length_m(), kRoadHalfWidth_m + 3, kLane_m);
                const double sign = left ? -1 : 1, from = s + sign * 6;
                const double to =
                    left ? std::max(0.0, s - 150) : std::min(main.length_m(), s + 150);
                const auto rest = linePoints(main, from, to, -sign * kLane_m);
                line.insert(line.end(), rest.begin(), rest.end());
                addEntry(line, r, 2);
                return;
            }
        }
    }

    /// Cars that keep with the own vehicle: one before it that slows down and speeds up, one behind
    /// it, and one that overtakes.
    void escort() {
        const double speed = std::max(1.0, options_.step_m / options_.period_s);
        overtakes_s_ = {4.0 + between(hash(seed_, 412U), 0, 4), std::max(8.0, 60.0 / speed)};
        const double begin = overtakes_s_.first, ease = overtakes_s_.second;
        const auto follow = [&](uint32_t k, const auto& gap, const auto& lateral) {
            population_.addVehicle(hash(seed_, 415U, k)).moving = true;
            Track& track = population_.tracks.back();
            track.parked = false;
            double way = 0;
            SE3 before;
            for (std::size_t f = 0; f < own_.size(); ++f) {
                const double t = static_cast<double>(f) * options_.period_s;
                const SE3 T = route_.path.poseAt(route_.path_m[f] + gap(t), lateral(t));
                // Heads where it goes, also while it changes lanes.
                const SE3 soon = route_.path.poseAt(
                    route_.path_m[f] + gap(t + 0.3) + 0.3 * ownSpeed_[f], lateral(t + 0.3));
                const Vec3 ahead = soon.translation() - T.translation();
                const double yaw =
                    ahead.norm() > 0.6 ? std::atan2(ahead.y(), ahead.x()) : T.yaw_rad();
                way += f == 0 ? 0 : (T.translation() - before.translation()).norm();
                before = T;
                track.spots.push_back(
                    {T.translation().x(), T.translation().y(), yaw, static_cast<float>(way)});
            }
        };
        const auto own = [](double) { return 0.0; };
        const double phase = between(hash(seed_, 413U), 0, 6.28);
        follow(
            0,
            [&](double t) {  // stop and go
                return 17.0 + 15.0 * smooth((t - 1.0) / 9.0) + 6.0 * std::sin(phase + t / 3.1) -
                       6.0 * std::sin(phase);
            },
            own);
        follow(
            1, [&](double t) { return -14.0 + 2.5 * std::sin(t / 4.0); }, own);
        follow(
            2, [&](double t) { return -30.0 + 44.0 * smooth((t - begin) / ease); },
            [&](double t) {
                const double x = (t - begin) / ease;
                return 2.1 * kLane_m * (smooth((x - 0.12) / 0.2) - smooth((x - 0.72) / 0.2));
            });
        escorts_ = {population_.actors.size() - 3, population_.actors.size() - 2,
                    population_.actors.size() - 1};
    }

    void addDriver(ActorType type, uint32_t seed, const Street& path, double lateral_m, double s_m,
                   double free_mps, double along) {
        Driver d;
        d.path = &path;
        d.s_m = s_m;
        d.lateral_m = lateral_m;
        d.free_mps = d.speed_mps = free_mps;
        d.cyclist = type == ActorType::Cyclist;
        d.along = along;
        d.T = d.poseAhead(0);
        const Vec2 here = d.T.translation().head<2>();
        for (const auto& o : drivers_)
            if ((o.T.translation().head<2>() - here).norm() < 14) return;
        if ((own_[frame_].translation().head<2>() - here).norm() < 14) return;
        for (std::size_t k : escorts_) {
            const Spot& q = population_.tracks[k].at(frame_);
            if ((Vec2(q.x_m, q.y_m) - here).norm() < 12) return;
        }
        Actor& actor = type == ActorType::Cyclist ? population_.add(type, 0, seed)
                                                  : population_.addVehicle(seed);
        actor.moving = true;
        d.actor = population_.actors.size() - 1;
        d.half_m = 0.5 * actor.size_m.x();
        d.halfWidth_m = 0.5 * actor.size_m.y();
        population_.tracks[d.actor].parked = false;
        population_.tracks[d.actor].first = frame_;
        drivers_.push_back(d);
        if (&path == &oncoming_) oncomers_.push_back(d.actor);
    }

    void spawnOncoming() {
        const double speed = between(hash(seed_, 410U), 7.0, 10.0);
        const double length = oncoming_.length_m();
        uint32_t n = 0;
        for (double s = 30; s < length - 10;) {
            const uint32_t h = hash(seed_, 411U, n++);
            const bool bicycle = !leftTaken_ && unit(hash(h, 1U)) < 0.25F;
            const double at = s;
            s += between(hash(h, 3U), 22.0, 75.0);
            if (meetsOvertaker(at, bicycle ? 4.2 : speed)) continue;
            addDriver(bicycle ? ActorType::Cyclist : ActorType::Car, hash(h, 2U), oncoming_,
                      bicycle ? -1.05 : 0.0, at, bicycle ? 4.2 : speed, -1);
        }
    }

    /// True if somebody who comes towards us would meet the car that overtakes on his lane.
    bool meetsOvertaker(double s0_m, double speed_mps) const {
        if (!convoy_.empty()) return false;
        const auto [begin, takes] = overtakes_s_;
        for (double t = begin - 1; t < begin + takes + 2; t += 0.5) {
            const auto f = static_cast<std::size_t>(t / options_.period_s);
            if (f >= own_.size()) break;
            for (double slower : {1.0, 0.6}) {
                const SE3 T = oncoming_.poseAt(s0_m - slower * speed_mps * t);
                if ((T.translation() - own_[f].translation()).norm() < 55) return true;
            }
        }
        return false;
    }

    void spawnFrom(std::size_t i) {
        Entry& e = entries_[i];
        const double now = static_cast<double>(frame_) * options_.period_s;
        if (now < e.next_s + overtakes_s_.first + overtakes_s_.second - 5) return;
        const uint32_t h = hash(e.seed, 30U, e.count++);
        e.next_s += between(h, 14.0, 40.0);
        addDriver(ActorType::Car, hash(h, 2U), e.path, 0.0, 1.0, e.speed_mps, 1);
    }

    /// All bodies now, and where they will be for some seconds.
    void look() {
        obstacles_.clear();
        const auto steps = static_cast<std::size_t>(std::lround(0.4 / options_.period_s));
        for (std::size_t k = 0; k <= 10; ++k) {
            const std::size_t f = frame_ + k * steps;
            if (f >= own_.size()) break;
            obstacles_.push_back(
                obstacleAt(own_[f], 0.5 * kOwnLength_m, kOwnHalfWidth_m, kOwn, false, k > 0));
            for (std::size_t i : escorts_) {
                const Spot& q = population_.tracks[i].at(f);
                const Vec3& size = population_.actors[i].size_m;
                obstacles_.push_back(obstacleAt(SE3::fromYaw(q.yaw_rad, Vec3(q.x_m, q.y_m, 0)),
                                                0.5 * size.x(), 0.5 * size.y(), kOwn, false,
                                                k > 0));
            }
        }
        for (std::size_t i = 0; i < drivers_.size(); ++i) {
            const Driver& d = drivers_[i];
            for (int k = 0; k <= 5; ++k)
                obstacles_.push_back(obstacleAt(d.poseAhead(0.4 * k * d.speed_mps), d.half_m,
                                                d.halfWidth_m, i, d.cyclist, k > 0));
        }
    }

    /// Free way ahead of a driver, m. Where others will be soon counts if they come from ahead or
    /// from the side and were there first, or yield to nobody.
    double gapOf(const Driver& d, std::size_t index) const {
        constexpr double kStep_m = 1.0, kInside_m = 2.6;
        const double reach = 10.0 + 0.3 * d.speed_mps * d.speed_mps;
        const Vec2 here = d.T.translation().head<2>(), x = d.T.rotation().col(0).head<2>();
        std::vector<const Obstacle*> close;
        for (const auto& o : obstacles_) {
            if (o.driver == index || (o.discs[1] - here).norm() > reach + d.half_m + 5) continue;
            if (o.soon && o.driver != kOwn && o.driver > index) continue;
            if (o.soon && o.heading.dot(x) > 0.7) {
                const Vec2 from = o.driver == kOwn ? own_[frame_].translation().head<2>()
                                                   : drivers_[o.driver].T.translation().head<2>();
                if (std::abs((from - here).dot(Vec2(-x.y(), x.x()))) < 1.2) continue;
            }
            close.push_back(&o);
        }
        if (close.empty()) return reach;
        for (double ahead = 0.5; ahead < reach; ahead += kStep_m) {
            const Vec2 p = d.poseAhead(d.half_m + ahead).translation().head<2>();
            for (const auto* o : close) {
                if (o->soon && ahead < kInside_m) continue;  // is past the place to wait at
                const double room =
                    o->radius_m + d.halfWidth_m + (o->cyclist || d.cyclist ? 0.03 : 0.3);
                for (const auto& disc : o->discs)
                    if ((disc - p).squaredNorm() < room * room) return ahead;
            }
        }
        return reach;
    }

    /// True if the own vehicle or its escort soon runs into a driver who goes along its way.
    bool inTheWay(const Driver& d) const {
        const Vec2 here = d.T.translation().head<2>(), x = d.T.rotation().col(0).head<2>();
        for (double seconds = 0; seconds < 8; seconds += 0.5) {
            const std::size_t f = frame_ + static_cast<std::size_t>(seconds / options_.period_s);
            if (f >= own_.size()) break;
            const Vec2 p = own_[f].translation().head<2>();
            const double beside = d.halfWidth_m + kOwnHalfWidth_m + 0.1;
            const Vec2 q = own_[f].rotation().transpose().topLeftCorner<2, 2>() * (here - p);
            if (std::abs(q.y()) > beside || std::abs(q.x()) > d.half_m + 0.5 * kOwnLength_m + 1)
                continue;
            const Vec2 ownX = own_[f].rotation().col(0).head<2>();
            const bool away =
                seconds > 0.4 && x.dot(ownX) > 0.8 && d.speed_mps > 0.8 * ownSpeed_[frame_];
            if (std::abs(x.dot(ownX)) > 0.8 && !away) return true;
        }
        return false;
    }

    void step() {
        look();
        const double dt = options_.period_s;
        std::vector<Driver> staying;
        for (std::size_t i = 0; i < drivers_.size(); ++i) {
            Driver d = drivers_[i];
            population_.tracks[d.actor].spots.push_back({d.T.translation().x(),
                                                         d.T.translation().y(), d.T.yaw_rad(),
                                                         static_cast<float>(d.way_m)});
            double wanted = d.free_mps;
            const Vec2 toOwn = d.T.rotation().transpose().topLeftCorner<2, 2>() *
                               (own_[frame_].translation() - d.T.translation()).head<2>();
            const bool ownBehind = toOwn.x() < 0 && toOwn.x() > -45 && std::abs(toOwn.y()) < 3 &&
                                   d.T.rotation().col(0).dot(own_[frame_].rotation().col(0)) > 0.5;
            if (ownBehind) wanted = std::max(wanted, ownSpeed_[frame_] + 1.5);
            const double bend = std::abs(d.path->curvatureAt(d.s_m + 4 * d.along));
            wanted = std::min(wanted, std::sqrt(2.2 / std::max(bend, 0.01)));
            const double gap = gapOf(d, i);
            wanted = std::min(wanted, std::sqrt(2 * 2.5 * std::max(0.0, gap - 3.6)));
            d.speed_mps += std::clamp(wanted - d.speed_mps, -6.0 * dt, 2.0 * dt);
            if (gap < 1.2) d.speed_mps = 0;
            d.s_m += d.along * d.speed_mps * dt;
            d.way_m += d.speed_mps * dt;
            d.T = d.poseAhead(0);
            if (!d.atEnd() && !inTheWay(d)) staying.push_back(d);
        }
        drivers_ = std::move(staying);
    }

    Population& population_;
    const Network& network_;
    const Route& route_;
    const WorldOptions& options_;
    const uint32_t seed_;
    std::vector<SE3> own_;
    std::vector<double> ownSpeed_;
    Street oncoming_{1.0, 0};
    std::vector<Entry> entries_;
    std::vector<ConvoyPlace> convoy_;
    bool leftTaken_ = false;            // by the convoy: the lane of those who come towards us
    std::vector<std::size_t> escorts_;  // actors: the escort or the convoy
    std::vector<std::size_t> oncomers_;
    std::pair<double, double> overtakes_s_{0, 0};  // begins at, takes
    std::vector<Driver> drivers_;
    std::vector<Obstacle> obstacles_;
    std::size_t frame_ = 0;
};

}  // namespace

void addTraffic(Population& population, const Network& network, const Route& route,
                const WorldOptions& options) {
    Traffic(population, network, route, options).run();
}

}  // namespace djpete::simulator
