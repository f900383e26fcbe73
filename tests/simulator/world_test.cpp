// Cars and the street they stand in.
#include <gtest/gtest.h>

#include <set>

#include "djpete/simulator/world.h"

namespace {

using namespace djpete::simulator;

TEST(World, HasCarsOfEveryBodyParkedAndMoving) {
    const World world(WorldOptions{});
    std::set<uint32_t> kinds, ids;
    std::size_t moving = 0, oncoming = 0;
    for (const auto& car : world.actors()) {
        kinds.insert(car.kind);
        ids.insert(car.id);
        moving += car.moving ? 1U : 0U;
        oncoming += car.moving && car.oncoming ? 1U : 0U;
        EXPECT_GT(car.size_m.x(), 3.0);
        EXPECT_LT(car.size_m.x(), 6.0);
        EXPECT_GT(car.size_m.y(), 1.5);
        EXPECT_LT(car.size_m.y(), 2.1);
        EXPECT_GT(car.size_m.z(), 1.3);
        EXPECT_LT(car.size_m.z(), 2.2);
    }
    EXPECT_GE(kinds.size(), 5U);
    EXPECT_EQ(ids.size(), world.actors().size());
    EXPECT_EQ(*ids.begin(), 1U);  // 0 means no car
    EXPECT_GE(oncoming, 5U);
    EXPECT_GE(moving, oncoming + 1);
}

TEST(World, ShorterDrivesSeeTheSameWorld) {
    WorldOptions brief, longer;
    brief.frames = 10;
    longer.frames = 500;
    const World a(brief), b(longer);
    ASSERT_EQ(a.actors().size(), b.actors().size());
    for (std::size_t i = 0; i < a.actors().size(); ++i) {
        EXPECT_EQ(a.actors()[i].s0_m, b.actors()[i].s0_m);
        EXPECT_EQ(a.actors()[i].seed, b.actors()[i].seed);
    }
}

TEST(World, NoTwoCarsTouch) {
    const World world(WorldOptions{});
    for (uint64_t frame : {0U, 50U, 99U}) {
        for (const auto& a : world.actors()) {
            for (const auto& b : world.actors()) {
                if (a.id >= b.id || !world.present(a, frame) || !world.present(b, frame)) continue;
                const auto T_a_b =
                    world.T_world_obj(a, frame).inverse() * world.T_world_obj(b, frame);
                const auto gap = T_a_b.translation().cwiseAbs() - 0.5 * (a.size_m + b.size_m);
                EXPECT_GT(std::max(gap.x(), gap.y()), 0.1)
                    << "cars " << a.id << " and " << b.id << " in frame " << frame;
            }
        }
    }
}

TEST(World, MovingCarsLeaveTheStreet) {
    WorldOptions options;
    options.frames = 900;
    const World world(options);
    std::size_t gone = 0;
    for (const auto& car : world.actors())
        gone += car.moving && world.present(car, 0) && !world.present(car, 899) ? 1U : 0U;
    EXPECT_GT(gone, 3U);
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

TEST(World, MoreCarsThanMasksCanTellApartIsAnError) {
    WorldOptions options;
    options.frames = 20000;
    EXPECT_THROW(World{options}, std::runtime_error);
}

}  // namespace
