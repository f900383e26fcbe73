// Vehicles that drive with the own one and hide a share of its image.
#include <algorithm>
#include <cmath>

#include "some_world.h"

namespace {

using namespace some_world;

bool isVehicle(const sim::Actor& a) {
    return a.type != sim::ActorType::Pedestrian && a.type != sim::ActorType::Cyclist;
}

/// Share of the left image that moving vehicles cover, mean over every `every`-th frame.
double movingShare(const sim::World& world, uint64_t every) {
    sim::Renderer renderer(world, 2);
    const auto camera = sim::rigCamera(310, 94);
    double sum = 0;
    int frames = 0;
    for (uint64_t f = 0; f < world.frames(); f += every, ++frames) {
        const auto image = renderer.renderCamera(f, camera, sim::T_vehicle_camera(), 0);
        const auto pixels =
            std::count_if(image.actorId.begin(), image.actorId.end(), [&](uint32_t id) {
                return id != 0 && world.actors()[id - 1].moving &&
                       isVehicle(world.actors()[id - 1]);
            });
        sum += static_cast<double>(pixels) / static_cast<double>(image.actorId.size());
    }
    return sum / frames;
}

TEST(Convoy, CoversTheShareOfTheImageThatIsAskedFor) {
    for (auto kind : {sim::RouteKind::Street, sim::RouteKind::Blocks}) {
        auto options = drive(kind, 300);
        options.convoyShare = 0.3;
        const double share = movingShare(sim::World(options), 15);
        EXPECT_GT(share, 0.25);
        EXPECT_LT(share, 0.35);
    }
    auto few = drive(sim::RouteKind::Street, 120);
    few.convoyShare = 0.1;
    EXPECT_NEAR(movingShare(sim::World(few), 15), 0.1, 0.04);
}

TEST(Convoy, KeepsTheOwnVehiclesSpeed) {
    auto options = drive(sim::RouteKind::Street, 200);
    options.convoyShare = 0.3;
    const sim::World world(options);
    int with = 0, ahead = 0;
    for (const auto& a : world.actors()) {
        if (!a.moving || !isVehicle(a) || !world.present(a, 0) || !world.present(a, 199)) continue;
        const Vec3 start =
            world.T_world_vehicle(0).inverse() * world.T_world_obj(a, 0).translation();
        const Vec3 end =
            world.T_world_vehicle(199).inverse() * world.T_world_obj(a, 199).translation();
        if ((end - start).norm() > 5) continue;  // comes towards us or drives elsewhere
        ++with;
        for (uint64_t f = 1; f < 200; ++f) {
            const Vec3 now =
                world.T_world_vehicle(f).inverse() * world.T_world_obj(a, f).translation();
            const Vec3 before =
                world.T_world_vehicle(f - 1).inverse() * world.T_world_obj(a, f - 1).translation();
            EXPECT_LT(std::abs(now.x() - before.x()) / options.period_s, 0.5) << f;
            if (std::abs(start.y()) > 2) continue;  // in the lane to the left
            const double gap = now.x() - 0.5 * a.size_m.x() - 0.27;
            EXPECT_GT(gap, 6.5) << f;
            EXPECT_LT(gap, 10.5) << f;
            ++ahead;
        }
    }
    EXPECT_GE(with, 2);
    EXPECT_GT(ahead, 150);
}

TEST(Convoy, LeavesStreetsAndPosesAsTheyAre) {
    for (auto kind : {sim::RouteKind::Street, sim::RouteKind::Blocks}) {
        const auto options = drive(kind, 100);
        auto convoy = options;
        convoy.convoyShare = 0.3;
        const sim::World a(options), b(convoy);
        for (uint64_t f = 0; f < 100; ++f)
            ASSERT_EQ(a.T_world_vehicle(f).matrix(), b.T_world_vehicle(f).matrix());
        if (kind == sim::RouteKind::Blocks) expectSameStreets(a, b);
    }
}

TEST(Convoy, TouchesNobody) {
    for (auto kind : {sim::RouteKind::Street, sim::RouteKind::Blocks}) {
        for (double share : {0.1, 0.3, 0.5}) {
            auto options = drive(kind, 300);
            options.convoyShare = share;
            SCOPED_TRACE(testing::Message()
                         << "route " << static_cast<int>(kind) << " share " << share);
            expectNobodyTouches(sim::World(options), 5);
        }
    }
}

}  // namespace
