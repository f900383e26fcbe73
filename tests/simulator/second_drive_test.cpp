// Drives through the same streets with other traffic, a lane offset or another sun.
#include <cmath>
#include <set>
#include <tuple>

#include "some_world.h"

namespace {

using namespace some_world;

/// Where a parked car stands and how it looks.
using Parked = std::tuple<double, double, uint32_t>;

std::set<Parked> parkedIn(const sim::World& world) {
    std::set<Parked> out;
    for (const auto& a : world.actors()) {
        if (a.moving || a.type == sim::ActorType::Pedestrian) continue;
        const Vec3 p = world.T_world_obj(a, 0).translation();
        out.insert({p.x(), p.y(), a.seed});
    }
    return out;
}

TEST(SecondDrive, HasOtherTrafficInTheSameStreets) {
    for (auto kind : {sim::RouteKind::Street, sim::RouteKind::Blocks}) {
        auto options = drive(kind, 60);
        const sim::World first(options);
        options.trafficSeed = 7;
        const sim::World second(options);
        if (kind == sim::RouteKind::Blocks) expectSameStreets(first, second);
        for (uint64_t f = 0; f < 60; ++f)
            ASSERT_EQ(first.T_world_vehicle(f).matrix(), second.T_world_vehicle(f).matrix());
        const auto before = parkedIn(first), after = parkedIn(second);
        std::size_t stayed = 0;
        for (const auto& car : before) stayed += after.count(car);
        const double share = static_cast<double>(stayed) / static_cast<double>(before.size());
        EXPECT_GT(share, 0.35);
        EXPECT_LT(share, 0.65);
        const double cars = static_cast<double>(after.size()) / static_cast<double>(before.size());
        EXPECT_GT(cars, 0.75);
        EXPECT_LT(cars, 1.3);
        std::set<uint32_t> seeds;
        for (const auto& a : first.actors())
            if (a.moving) seeds.insert(a.seed);
        int moving = 0;
        for (const auto& a : second.actors()) {
            if (!a.moving) continue;
            ++moving;
            EXPECT_EQ(seeds.count(a.seed), 0U) << "actor " << a.id;
        }
        EXPECT_GT(moving, 10);
        expectNobodyTouches(second, 10);
    }
}

TEST(SecondDrive, WithALaneOffsetItSharesTheFirstOnesWorld) {
    for (auto kind : {sim::RouteKind::Street, sim::RouteKind::Blocks}) {
        auto options = drive(kind, 200);
        const sim::World first(options);
        options.laneOffset_m = 0.4;
        const sim::World second(options);
        EXPECT_EQ(first.T_world_start().matrix(), first.T_world_vehicle(0).matrix());
        EXPECT_EQ(first.T_world_start().matrix(), second.T_world_start().matrix());
        for (uint64_t f = 0; f < 200; ++f) {
            const Vec3 left =
                (first.T_world_vehicle(f).inverse() * second.T_world_vehicle(f)).translation();
            EXPECT_NEAR(left.x(), 0, 0.01);
            EXPECT_NEAR(left.y(), 0.4, 0.01);
            EXPECT_NEAR(left.z(), 0, 0.02);
        }
        expectNobodyTouches(second, 10);
    }
}

TEST(SecondDrive, FilesOfDrivesWithAndWithoutOffsetShareOneWorld) {
    const auto dir = djpete_test::scratch("sim_second_drive");
    std::vector<std::string> words{"--frames", "3:4",        "--size",
                                   "128x64",   "--no-color", "--no-scans"};
    const auto write = [&](const char* name, const std::vector<std::string>& more) {
        std::vector<std::string> all{"--out", (dir / name).string()};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), more.begin(), more.end());
        small_drive::simulate(all);
    };
    write("first", {});
    write("beside", {"--lane-offset", "0.5"});
    write("sun", {"--sun-deg", "60"});
    const auto a = small_drive::numbersOf(dir / "first" / "poses.txt");
    const auto b = small_drive::numbersOf(dir / "beside" / "poses.txt");
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t f = 0; f < a.size(); ++f) {
        EXPECT_NEAR(b[f][3] - a[f][3], -0.5, 0.02);  // x of a camera points to the right
        EXPECT_NEAR(b[f][7], a[f][7], 0.02);
        EXPECT_NEAR(b[f][11], a[f][11], 0.02);
    }
    // Shadows move, and nothing else.
    const std::string picture = "image_0/000003.png", masks = "instances/000003.png";
    const auto files = small_drive::filesOf(dir / "first"), sun = small_drive::filesOf(dir / "sun");
    EXPECT_NE(files.at(picture), sun.at(picture));
    EXPECT_EQ(files.at(masks), sun.at(masks));
    EXPECT_EQ(files.at("poses.txt"), sun.at("poses.txt"));
}

}  // namespace
