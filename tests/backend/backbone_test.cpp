#include "djpete/backend/backbone.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

/// A map whose keyframes and points are off the truth, with exact or noisy observations.
struct World {
    map::SlamMap map;
    std::vector<SE3> T_world_cam;
    std::vector<Vec3> p_world;
    std::set<std::pair<uint64_t, uint64_t>> outliers;  // landmark, keyframe
};

World makeWorld(unsigned keyframes, double pixelSigma, double outlierShare, uint64_t seed = 1) {
    World w;
    djpete_test::Random random(seed);
    const auto camera = djpete_test::kittiCamera();
    for (unsigned j = 0; j < 400; ++j) {
        w.p_world.emplace_back(random.uniform(-15, 15), random.uniform(-4, 2),
                               random.uniform(5, 40 + keyframes));
        const Vec3 start = w.p_world.back() + random.normal3(0.1);
        w.map.addLandmark(start, {});
    }
    for (unsigned i = 0; i < keyframes; ++i) {
        const SE3 truth = SE3::fromYaw(0, {0.05 * i, 0, 0.9 * i});
        w.T_world_cam.push_back(truth);
        Vec6 noise;
        noise << random.normal3(0.05), random.normal3(0.003);
        map::Keyframe kf;
        kf.frame = {i};
        kf.camera = camera;
        kf.T_world_cam = i == 0 ? truth : truth * SE3::exp(noise);
        kf.T_odom_cam = kf.T_world_cam;
        std::vector<map::LandmarkId> seen;
        for (unsigned j = 0; j < 400; ++j) {
            const Vec3 p_cam = truth.inverse() * w.p_world[j];
            if (p_cam.z() < 3) continue;
            Vec3 uvu = camera.projectStereo(p_cam) + random.normal3(pixelSigma);
            if (!camera.contains(uvu.head<2>())) continue;
            if (random.uniform() < outlierShare) {
                uvu += Vec3(20, -15, 9);
                w.outliers.insert({j, i});
            }
            obs::KeyframeFeature f;
            f.u_px = static_cast<float>(uvu.x());
            f.v_px = static_cast<float>(uvu.y());
            f.uRight_px = static_cast<float>(uvu.z());
            kf.features.push_back(f);
            seen.push_back({j});
        }
        const auto id = w.map.addKeyframe(kf, true);
        for (uint32_t k = 0; k < seen.size(); ++k) w.map.observe(seen[k], id, k);
    }
    return w;
}

TEST(BackboneProblem, theNewestMoveTheOthersHold) {
    const auto w = makeWorld(8, 0, 0);
    BackboneOptions options;
    options.maxFixed = 3;
    const auto p = backboneProblem(w.map, options, 4);
    unsigned free = 0, fixed = 0;
    for (const auto& c : p.cameras) (c.fixed ? fixed : free) += 1;
    EXPECT_EQ(free, 4U);
    EXPECT_EQ(fixed, 3U);
    EXPECT_FALSE(p.cameras.back().fixed);
    EXPECT_EQ(p.cameras.back().id, w.map.lastKeyframe()->id);
    std::vector<unsigned> views(p.points.size(), 0);
    for (const auto& o : p.observations) ++views[o.point];
    for (const unsigned v : views) EXPECT_GE(v, 2U);
    EXPECT_TRUE(p.odometry.empty());
}

TEST(BackboneProblem, theFirstKeyframeNeverMoves) {
    const auto w = makeWorld(4, 0, 0);
    const auto p = backboneProblem(w.map, {}, 10);
    ASSERT_EQ(p.cameras.size(), 4U);
    for (const auto& c : p.cameras) EXPECT_EQ(c.fixed, c.id == map::KeyframeId{0});
    EXPECT_TRUE(backboneProblem(map::SlamMap(), {}, 10).cameras.empty());
}

TEST(BackboneSolve, exactObservationsGiveTheTruth) {
    const auto w = makeWorld(8, 0, 0);
    BackboneOptions options;
    options.firstIterations = options.secondIterations = 30;
    const auto update = solve(backboneProblem(w.map, options, 10), options);
    ASSERT_EQ(update.cameras.size(), 7U);
    for (const auto& [id, T_world_cam] : update.cameras) {
        const Vec6 e = (w.T_world_cam[id.value].inverse() * T_world_cam).log();
        EXPECT_LT(e.norm(), 1e-3) << "keyframe " << id.value;  // floats hold 1e-5 of a pixel column
    }
    EXPECT_TRUE(update.outliers.empty());
    EXPECT_LT(update.report.finalCost, update.report.initialCost + 1e-12);
}

TEST(BackboneSolve, findsTheOutliersAndOnlyThose) {
    const auto w = makeWorld(8, 0.3, 0.05);
    const auto update = solve(backboneProblem(w.map, {}, 10), {});
    std::set<std::pair<uint64_t, uint64_t>> found;
    for (const auto& [landmark, keyframe] : update.outliers) {
        found.insert({landmark.value, keyframe.value});
    }
    std::set<uint64_t> culled;
    for (const auto id : update.culled) culled.insert(id.value);
    unsigned missed = 0;
    for (const auto& o : w.outliers) {
        missed += found.count(o) == 0 && culled.count(o.first) == 0 ? 1U : 0U;
    }
    unsigned wrong = 0;
    for (const auto& o : found) wrong += w.outliers.count(o) == 0 ? 1U : 0U;
    ASSERT_GT(w.outliers.size(), 50U);
    EXPECT_LE(missed, w.outliers.size() / 20);
    EXPECT_LE(wrong, found.size() / 5);
    for (const auto& [id, T_world_cam] : update.cameras) {
        const Vec6 e = (w.T_world_cam[id.value].inverse() * T_world_cam).log();
        EXPECT_LT(e.head<3>().norm(), 0.02);
        EXPECT_LT(e.tail<3>().norm(), 0.001);
    }
}

TEST(BackboneSolve, isPure) {
    const auto w = makeWorld(6, 0.5, 0.02);
    const auto p = backboneProblem(w.map, {}, 10);
    const auto a = solve(p, {}), b = solve(p, {});
    ASSERT_EQ(a.cameras.size(), b.cameras.size());
    for (std::size_t i = 0; i < a.cameras.size(); ++i) {
        EXPECT_EQ(a.cameras[i].second.matrix(), b.cameras[i].second.matrix());
    }
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i)
        EXPECT_EQ(a.points[i].second, b.points[i].second);
}

TEST(BackboneSolve, aKeyframeWithoutLandmarksIsHeldByOdometry) {
    auto w = makeWorld(4, 0, 0);
    map::Keyframe blind;
    blind.frame = {9};
    blind.camera = djpete_test::kittiCamera();
    const auto& last = *w.map.lastKeyframe();
    blind.T_odom_cam = last.T_odom_cam * SE3::fromYaw(0, {0, 0, 1});
    blind.T_world_cam = last.T_world_cam * SE3::fromYaw(0, {0, 0, 1});
    const auto id = w.map.addKeyframe(blind, true);
    const auto p = backboneProblem(w.map, {}, 10);
    ASSERT_EQ(p.odometry.size(), 1U);
    const auto update = solve(p, {});
    ASSERT_EQ(update.cameras.back().first, id);
    const SE3 T =
        update.cameras[update.cameras.size() - 2].second.inverse() * update.cameras.back().second;
    EXPECT_LT((T.translation() - Vec3(0, 0, 1)).norm(), 1e-3);
}

}  // namespace
}  // namespace djpete::backend
