#include "djpete/scans/prepared_scan.h"

#include <gmock/gmock.h>

#include <set>

#include "made_up_street.h"

namespace djpete::scans {
namespace {

using made_up::SE3;
using made_up::Vec3;
using made_up::Vec6;

TEST(PreparedScan, LeavesOutWhatCannotBeUsed) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    obs::LidarScan scan;
    scan.points = {{nan, 1, 1, 0}, {10, inf, 0, 0}, {0, 0, 0, 0},
                   {1, 0, 0, 0},   {500, 0, 0, 0},  {10, 5, -1, 0}};
    const auto out = prepareScan(scan, {});
    ASSERT_EQ(out.points.size(), 1U);
    EXPECT_EQ(out.points[0], Eigen::Vector3f(10, 5, -1));
    EXPECT_THAT(out.toMatch, testing::ElementsAre(0U));
    EXPECT_TRUE(prepareScan({}, {}).points.empty());
}

TEST(PreparedScan, KeepsTheFirstPointOfEachCube) {
    const ScanOptions options;
    const auto scan = made_up::scanOf(made_up::houses(), SE3(), 0, 1);
    const auto out = prepareScan(scan, options);
    const auto cubes = [&](const std::vector<Eigen::Vector3f>& points, double size) {
        std::set<std::array<long, 3>> all;
        for (const auto& p : points) {
            all.insert({std::lround(std::floor(double(p.x()) / size)),
                        std::lround(std::floor(double(p.y()) / size)),
                        std::lround(std::floor(double(p.z()) / size))});
        }
        return all;
    };
    EXPECT_EQ(cubes(out.points, options.mapSpacing_m).size(), out.points.size());
    std::vector<Eigen::Vector3f> inRange, matched;
    for (const auto& p : scan.points) {
        const double range = p.position().norm();
        if (range >= options.minRange_m && range <= options.maxRange_m) {
            inRange.emplace_back(p.x, p.y, p.z);
        }
    }
    EXPECT_EQ(cubes(inRange, options.mapSpacing_m), cubes(out.points, options.mapSpacing_m));
    for (const auto i : out.toMatch) matched.push_back(out.points.at(i));
    EXPECT_EQ(cubes(matched, options.matchSpacing_m).size(), matched.size());
    EXPECT_EQ(cubes(matched, options.matchSpacing_m), cubes(out.points, options.matchSpacing_m));
}

TEST(PreparedScan, AScannerThatTurnsWhileDrivingIsSetRight) {
    ScanOptions options;
    options.spinPeriod_s = 0.1;
    Vec6 perSecond;
    perSecond << 12, 0, 0, 0, 0, 0.5;
    made_up::Street walls;
    walls.ground = false;
    walls.boxes = {{{20, -40, -2}, {22, 40, 8}}, {{-40, 12, -2}, {19, 13, 8}}};
    const auto scan = made_up::scanOf(walls, SE3(), 0, 1, 0.1 * perSecond);
    const auto prepared = prepareScan(scan, options);
    const auto offWall = [](const Vec3& p) {
        double best = 1e9;
        for (const double d : {p.x() - 20, p.y() - 12}) best = std::min(best, std::abs(d));
        return best;
    };
    double raw = 0, set = 0;
    for (const auto& p : atOneInstant(prepared, Vec6::Zero(), options)) {
        raw = std::max(raw, offWall(p));
    }
    for (const auto& p : atOneInstant(prepared, perSecond, options))
        set = std::max(set, offWall(p));
    EXPECT_GT(raw, 0.1);
    EXPECT_LT(set, 0.01);
}

}  // namespace
}  // namespace djpete::scans
