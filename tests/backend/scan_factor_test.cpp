/// Motions measured by scans in local adjustment.
#include <gmock/gmock.h>

#include "djpete/backend/backbone.h"
#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;

Mat6 informationOf(double sigma_m, double sigma_rad) {
    Mat6 out = Mat6::Zero();
    out.diagonal().head<3>().setConstant(1 / (sigma_m * sigma_m));
    out.diagonal().tail<3>().setConstant(1 / (sigma_rad * sigma_rad));
    return out;
}

SE3 truthAt(unsigned keyframe) { return SE3::fromYaw(0, {0, 0, 2.0 * keyframe}); }

/// Keyframes 2 m apart that see few, noisy points in a stereo camera that believes its baseline
/// 1 % longer than it is, so that everything looks 1 % larger; scans measured the true motions.
map::SlamMap mapOf(unsigned keyframes, bool scans, unsigned wrongScan = 0) {
    djpete_test::Random random(3);
    map::SlamMap out;
    auto camera = djpete_test::kittiCamera();
    auto believed = camera;
    believed.baseline_m *= 1.01;
    std::vector<Vec3> points;
    for (unsigned j = 0; j < 60 * keyframes; ++j) {
        points.emplace_back(random.uniform(-15, 15), random.uniform(-4, 2),
                            random.uniform(5, 30 + 2 * keyframes));
        out.addLandmark(1.01 * points.back(), {});
    }
    for (unsigned i = 0; i < keyframes; ++i) {
        map::Keyframe kf;
        kf.frame = {5 * i};
        kf.camera = believed;
        kf.T_world_cam = kf.T_odom_cam = SE3::fromYaw(0, {0, 0, 2.02 * i});
        if (scans && i > 0) {
            kf.scanMotion = obs::ScanMotion{
                {5 * (i - 1)}, truthAt(i - 1).inverse() * truthAt(i), informationOf(0.001, 1e-4)};
            if (i == wrongScan) kf.scanMotion->T_from_cam = SE3::fromYaw(0, {0, 0, 3});
        }
        std::vector<map::LandmarkId> seen;
        for (unsigned j = 0; j < points.size(); ++j) {
            const Vec3 p_cam = truthAt(i).inverse() * points[j];
            if (p_cam.z() < 3 || p_cam.z() > 40) continue;
            const Vec3 uvu = camera.projectStereo(p_cam) + random.normal3(0.3);
            if (!camera.contains(uvu.head<2>())) continue;
            obs::KeyframeFeature f;
            f.u_px = static_cast<float>(uvu.x());
            f.v_px = static_cast<float>(uvu.y());
            f.uRight_px = static_cast<float>(uvu.z());
            kf.features.push_back(f);
            seen.push_back({j});
        }
        const auto id = out.addKeyframe(kf, true);
        for (uint32_t k = 0; k < seen.size(); ++k) out.observe(seen[k], id, k);
    }
    return out;
}

double lengthAfter(const map::SlamMap& map) {
    BackboneOptions options;
    options.firstIterations = options.secondIterations = 30;
    const auto update = solve(backboneProblem(map, options, 20), options);
    EXPECT_TRUE(update.report.usable());
    return update.cameras.back().second.translation().z();
}

TEST(ScanFactor, ScansCorrectAWrongBaseline) {
    const double truth = truthAt(7).translation().z();
    const double without = lengthAfter(mapOf(8, false)), with = lengthAfter(mapOf(8, true));
    EXPECT_GT(std::abs(without - truth), 0.1);
    EXPECT_LT(std::abs(with - truth), 0.5 * std::abs(without - truth));
}

TEST(ScanFactor, AWrongScanPullsLittle) {
    EXPECT_NEAR(lengthAfter(mapOf(8, true, 4)), lengthAfter(mapOf(8, true)), 0.1);
}

TEST(ScanFactor, JoinsKeyframesOfTheWindowThatBothHaveScans) {
    const auto p = backboneProblem(mapOf(6, true), {}, 20);
    ASSERT_EQ(p.scans.size(), 5U);
    for (const auto& s : p.scans) EXPECT_EQ(s.b, s.a + 1);
    EXPECT_TRUE(backboneProblem(mapOf(6, false), {}, 20).scans.empty());
}

TEST(ScanFactor, AMotionFromAFrameThatIsNoKeyframeOrOfAnotherSegmentIsLeftOut) {
    map::SlamMap map;
    for (unsigned i = 0; i < 5; ++i) {
        map::Keyframe kf;
        kf.frame = {5 * i};
        kf.camera = djpete_test::kittiCamera();
        kf.segment = i < 3 ? 0 : 1;
        kf.T_world_cam = kf.T_odom_cam = truthAt(i);
        const uint64_t from = i == 2 ? 6 : 5 * (i - 1);
        if (i > 0) kf.scanMotion = obs::ScanMotion{{from}, truthAt(1), informationOf(0.01, 1e-3)};
        map.addKeyframe(kf, true);
    }
    const auto p = backboneProblem(map, {}, 20);
    std::vector<std::pair<uint64_t, uint64_t>> joined;
    for (const auto& s : p.scans) {
        joined.emplace_back(p.cameras[s.a].id.value, p.cameras[s.b].id.value);
    }
    EXPECT_THAT(joined, testing::ElementsAre(std::pair<uint64_t, uint64_t>{0, 1},
                                             std::pair<uint64_t, uint64_t>{3, 4}));
}

}  // namespace
}  // namespace djpete::backend
