// Cars and the street they stand in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "djpete/simulator/world.h"

namespace {

using namespace djpete::simulator;
using djpete::geometry::SE3;
using djpete::geometry::Vec2;
using djpete::geometry::Vec3;

WorldOptions blocks(uint64_t frames) {
    WorldOptions o;
    o.route = RouteKind::Blocks;
    o.frames = frames;
    return o;
}

/// Poses of a camera that goes round a rectangle of streets twice, up and down a little hill.
WorldOptions twiceRound() {
    WorldOptions o;
    constexpr double kWide = 120, kDeep = 80, kRadius = 10;
    const auto camera = [](const Vec2& p, double heading) {
        Eigen::Matrix3d axes;  // camera axes of a vehicle that heads along x
        axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        const double height = 1.5 * std::sin(p.x() / 40.0);
        return SE3::fromYaw(heading, Vec3(p.x(), p.y(), height)) * SE3(axes, Vec3::Zero());
    };
    std::vector<SE3> T_map_cam;
    Vec2 at(0, 0);
    double heading = 0;
    for (int edge = 0; edge < 9; ++edge) {
        const double way = (edge % 2 == 0 ? kWide : kDeep) - 2 * kRadius;
        for (double s = 0; s < way; s += 0.8) {
            T_map_cam.push_back(camera(at, heading));
            at += 0.8 * Vec2(std::cos(heading), std::sin(heading));
        }
        for (int k = 0; k < 20; ++k) {
            T_map_cam.push_back(camera(at, heading));
            heading += M_PI / 40;
            at += M_PI / 40 * kRadius * Vec2(std::cos(heading), std::sin(heading));
        }
    }
    for (const auto& T : T_map_cam) o.T_first_cam.push_back(T_map_cam.front().inverse() * T);
    return o;
}

/// Free space between the boxes of two actors (or of an actor and the own vehicle), seen from
/// above; negative where they overlap. Of the axes of both boxes.
double gapBetween(const SE3& T_world_a, const Vec3& a, const SE3& T_world_b, const Vec3& b) {
    double gap = -1e9;
    for (const auto* T : {&T_world_a, &T_world_b}) {
        for (int k = 0; k < 2; ++k) {
            const Vec3 axis = T->rotation().col(k);
            const auto reach = [&](const SE3& of, const Vec3& size) {
                return 0.5 * (std::abs(axis.dot(of.rotation().col(0))) * size.x() +
                              std::abs(axis.dot(of.rotation().col(1))) * size.y());
            };
            const double apart =
                std::abs(axis.dot(T_world_b.translation() - T_world_a.translation()));
            gap = std::max(gap, apart - reach(T_world_a, a) - reach(T_world_b, b));
        }
    }
    return gap;
}

void expectNobodyTouches(const World& world, uint64_t every) {
    const Vec3 own(4.4, 1.8, 1.5);
    for (uint64_t f = 0; f < world.frames(); f += every) {
        std::vector<const Actor*> here;
        for (const auto& a : world.actors())
            if (world.present(a, f)) here.push_back(&a);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const SE3 T_world_a = world.T_world_obj(*here[i], f);
            EXPECT_GT(gapBetween(T_world_a, here[i]->size_m, world.T_world_vehicle(f), own), 0.0)
                << "actor " << here[i]->id << " and the own vehicle in frame " << f;
            for (std::size_t j = i + 1; j < here.size(); ++j) {
                const SE3 T_world_b = world.T_world_obj(*here[j], f);
                if ((T_world_a.translation() - T_world_b.translation()).norm() > 12) continue;
                EXPECT_GT(gapBetween(T_world_a, here[i]->size_m, T_world_b, here[j]->size_m), 0.0)
                    << nameOf(here[i]->type) << " " << here[i]->id << " and "
                    << nameOf(here[j]->type) << " " << here[j]->id << " in frame " << f;
            }
        }
    }
}

TEST(World, HasVehiclesOfEveryBodyParkedAndMovingAndPeople) {
    const World world(WorldOptions{});
    std::set<std::pair<ActorType, uint32_t>> kinds;
    std::map<ActorType, std::pair<int, int>> still_moving;
    std::set<uint32_t> ids;
    for (const auto& a : world.actors()) {
        ids.insert(a.id);
        auto& count = still_moving[a.type];
        ++(a.moving ? count.second : count.first);
        if (a.type == ActorType::Pedestrian || a.type == ActorType::Cyclist) continue;
        kinds.insert({a.type, a.kind});
        EXPECT_GT(a.size_m.x(), 3.0);
        EXPECT_LT(a.size_m.x(), a.type == ActorType::Truck ? 9.0 : 6.5);
        EXPECT_GT(a.size_m.y(), 1.5);
        EXPECT_LT(a.size_m.y(), 2.6);
        EXPECT_GT(a.size_m.z(), 1.3);
        EXPECT_LT(a.size_m.z(), 3.8);
    }
    EXPECT_GE(kinds.size(), 7U);
    EXPECT_EQ(ids.size(), world.actors().size());
    EXPECT_EQ(*ids.begin(), 1U);  // 0 means nobody
    EXPECT_EQ(*ids.rbegin(), ids.size());
    EXPECT_GT(still_moving[ActorType::Car].first, 40);
    EXPECT_GT(still_moving[ActorType::Car].second, 8);
    EXPECT_GT(still_moving[ActorType::Pedestrian].second, 10);
    EXPECT_GT(still_moving[ActorType::Cyclist].second, 0);
}

TEST(World, ShorterDrivesSeeTheSameWorld) {
    for (auto kind : {RouteKind::Street, RouteKind::Blocks}) {
        WorldOptions brief, longer;
        brief.route = longer.route = kind;
        brief.frames = 30;
        longer.frames = 200;
        const World a(brief), b(longer);
        ASSERT_LE(a.actors().size(), b.actors().size());
        for (const auto& actor : a.actors()) {
            const Actor& same = b.actors()[actor.id - 1];
            EXPECT_EQ(actor.seed, same.seed);
            EXPECT_EQ(actor.type, same.type);
            for (uint64_t f : {0U, 15U, 29U}) {
                ASSERT_EQ(a.present(actor, f), b.present(same, f)) << actor.id << " " << f;
                if (!a.present(actor, f)) continue;
                EXPECT_EQ(
                    (a.T_world_obj(actor, f).translation() - b.T_world_obj(same, f).translation())
                        .norm(),
                    0)
                    << "actor " << actor.id << " in frame " << f;
            }
        }
        for (uint64_t f = 0; f < 30; ++f)
            EXPECT_EQ(
                (a.T_world_vehicle(f).translation() - b.T_world_vehicle(f).translation()).norm(),
                0);
    }
}

TEST(World, NobodyTouchesAnybodyInAStreet) {
    for (uint32_t seed : {1U, 2U, 3U}) {
        WorldOptions o;
        o.seed = seed;
        o.frames = 200;
        expectNobodyTouches(World(o), 5);
    }
}

TEST(World, NobodyTouchesAnybodyRoundBlocks) { expectNobodyTouches(World(blocks(400)), 5); }

TEST(World, NobodyTouchesAnybodyAlongPoses) { expectNobodyTouches(World(twiceRound()), 10); }

TEST(World, CarsOvertakeStopAndTurn) {
    const World world(blocks(300));
    bool overtakes = false, stops = false, turns = false, drivesOn = false;
    for (const auto& a : world.actors()) {
        if (!a.moving || a.type == ActorType::Pedestrian) continue;
        bool behind = false, halted = false;
        double turned = 0;
        for (uint64_t f = 1; f < world.frames(); ++f) {
            if (!world.present(a, f) || !world.present(a, f - 1)) continue;
            const SE3 T = world.T_world_obj(a, f), before = world.T_world_obj(a, f - 1);
            const double way = (T.translation() - before.translation()).norm();
            EXPECT_LT(way, 2.5) << "actor " << a.id << " jumps in frame " << f;
            turned += std::remainder(T.yaw_rad() - before.yaw_rad(), 2 * M_PI);
            const Vec3 p = world.T_world_vehicle(f).inverse() * T.translation();
            const bool near = std::abs(p.y()) < 5 && std::abs(p.x()) < 40;
            behind = behind || (near && p.x() < -5);
            overtakes = overtakes || (behind && near && p.x() > 8);
            if (way < 0.01) halted = true;
            if (halted && way > 0.2) drivesOn = true;
        }
        stops = stops || halted;
        turns = turns || std::abs(turned) > 1.2;
    }
    EXPECT_TRUE(overtakes);
    EXPECT_TRUE(stops);
    EXPECT_TRUE(drivesOn);
    EXPECT_TRUE(turns);
}

TEST(World, TheOwnVehicleDrivesAStepPerFrame) {
    const World world(WorldOptions{});
    for (uint64_t f = 1; f < 100; ++f) {
        const auto step =
            (world.T_world_vehicle(f - 1).inverse() * world.T_world_vehicle(f)).translation();
        EXPECT_NEAR(step.norm(), world.options().step_m, 0.05);
        EXPECT_GT(step.x(), 0.7);
        EXPECT_NEAR(world.T_world_vehicle(f).translation().z(), 1.73, 0.05);
    }
}

TEST(World, BlocksComeBackToTheSamePlaces) {
    const World world(blocks(1000));
    int closed = 0;
    for (uint64_t f = 400; f < 1000; f += 10) {
        for (uint64_t g = 0; g + 300 < f; ++g) {
            const Vec3 d =
                world.T_world_vehicle(f).translation() - world.T_world_vehicle(g).translation();
            if (d.norm() < 1.0) {
                ++closed;
                break;
            }
        }
    }
    EXPECT_GT(closed, 20);
}

TEST(World, GivenPosesAreDriven) {
    const WorldOptions options = twiceRound();
    const World world(options);
    ASSERT_EQ(world.frames(), options.T_first_cam.size());
    const SE3 T_first_world = (world.T_world_vehicle(0) * T_vehicle_camera()).inverse();
    for (uint64_t f = 0; f < world.frames(); f += 7) {
        const SE3 T = T_first_world * world.T_world_vehicle(f) * T_vehicle_camera();
        const SE3 error = options.T_first_cam[f].inverse() * T;
        EXPECT_LT(error.translation().norm(), 0.35) << "frame " << f;  // the height is smoothed
        EXPECT_LT((error.rotation() - Eigen::Matrix3d::Identity()).norm(), 1e-9) << "frame " << f;
    }
    // The second round stands on the same ground as the first.
    const Vec3 p = world.T_world_vehicle(40).translation();
    double least = 1e9;
    for (uint64_t f = 300; f < world.frames(); ++f)
        least = std::min(least, (world.T_world_vehicle(f).translation() - p).norm());
    EXPECT_LT(least, 0.5);
}

TEST(World, PosesThatLeadNowhereAreAnError) {
    WorldOptions o;
    o.T_first_cam.assign(5, SE3());
    EXPECT_THROW(World{o}, std::runtime_error);
}

TEST(World, VeryLongDrivesAreNoError) {
    WorldOptions options;
    options.frames = 4000;
    const World world(options);
    std::size_t parked = 0;
    for (const auto& a : world.actors()) parked += a.moving ? 0U : 1U;
    EXPECT_GT(parked, 200U);
    EXPECT_LT(parked, 999U);
}

}  // namespace
