/// Objects in the backbone: they help where features are few, and never where they are not.
#include "djpete/backend/joint.h"

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <thread>

#include "djpete/backend/map_keeper.h"
#include "djpete_test/synthetic_drive.h"
#include "map_bytes.h"

namespace djpete::backend {
namespace {

using djpete_test::cameraNumbers;
using djpete_test::DriveOptions;
using djpete_test::makeDrive;
using djpete_test::mapNumbers;
using djpete_test::sameBytes;
using djpete_test::SyntheticDrive;
using geometry::SE3;
using geometry::Vec3;

BackendOptions in(ObjectMode mode) {
    BackendOptions options;
    options.objects.mode = mode;
    return options;
}

std::unique_ptr<MapKeeper> run(const SyntheticDrive& drive, const BackendOptions& options,
                               Mode mode = Mode::Lockstep, MapKeeper::BeforeSolve before = {}) {
    auto keeper = std::make_unique<MapKeeper>(options, mode, std::move(before));
    for (const auto& f : drive.frames) keeper->addFrame(f.keyframe, f.detections);
    keeper->finish();
    keeper->map().check();
    return keeper;
}

double rmse(const SyntheticDrive& drive, const map::SlamMap& map) {
    double sum = 0;
    for (std::size_t i = 0; i < drive.frames.size(); ++i) {
        sum += (map.cameraAt({i})->translation() - drive.frames[i].T_world_cam.translation())
                   .squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(drive.frames.size()));
}

/// Hardly a point to hold on to, and a street full of parked cars.
DriveOptions poorDrive(uint64_t seed) {
    DriveOptions o;
    o.seed = seed;
    o.frames = 100;
    o.pointsPerMetre = 0.15;
    o.spacing_m = 4;
    o.odometrySigma_m = 0.03;
    return o;
}

/// On the mean of drives: in a single one chance may favour either (of 16 seeds joint is worse by
/// more than 1 % in 4, by 16 % at most, and better by 33 % on the mean).
TEST(JointMode, isBetterOnTheMeanWhereFeaturesAreFew) {
    double worker = 0, joint = 0;
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        const auto drive = makeDrive(poorDrive(seed));
        const double w = rmse(drive, run(drive, in(ObjectMode::Worker))->map());
        const auto keeper = run(drive, in(ObjectMode::Joint));
        const double j = rmse(drive, keeper->map());
        std::cout << "seed " << seed << ": worker " << w << " m, joint " << j << " m, "
                  << keeper->statistics().jointAccepted << " of "
                  << keeper->statistics().jointSolves << " solves with objects\n";
        worker += w;
        joint += j;
        EXPECT_GT(keeper->statistics().jointAccepted, 0U);
    }
    EXPECT_LT(joint, 0.8 * worker);
}

TEST(JointMode, changesNothingWhereFeaturesAreMany) {
    DriveOptions o;
    o.frames = 60;
    const auto drive = makeDrive(o);
    const auto worker = run(drive, in(ObjectMode::Worker)),
               joint = run(drive, in(ObjectMode::Joint));
    EXPECT_TRUE(sameBytes(mapNumbers(worker->map()), mapNumbers(joint->map())));
    EXPECT_EQ(joint->statistics().jointSolves, 0U);
}

TEST(JointMode, withoutDetectionsTheModesAreOne) {
    auto drive = makeDrive(poorDrive(1));
    for (auto& f : drive.frames) f.detections.reset();
    const auto off = run(drive, in(ObjectMode::Off)), joint = run(drive, in(ObjectMode::Joint));
    EXPECT_TRUE(sameBytes(mapNumbers(off->map()), mapNumbers(joint->map())));
}

/// Detections that are far worse than they say are no evidence: the cameras stay as without them.
TEST(JointMode, theGateRefusesDetectionsThatDisagree) {
    auto o = poorDrive(2);
    o.missShare = 0.1;
    auto drive = makeDrive(o);
    for (auto& f : drive.frames) {
        for (auto& d : f.detections->detections) d.information *= 40;
    }
    const auto worker = run(drive, in(ObjectMode::Worker)),
               joint = run(drive, in(ObjectMode::Joint));
    EXPECT_GT(joint->statistics().jointSolves, 0U);
    EXPECT_EQ(joint->statistics().jointAccepted, 0U);
    EXPECT_TRUE(sameBytes(cameraNumbers(worker->map()), cameraNumbers(joint->map())));
}

TEST(JointMode, lockstepAndThreadsUnderRandomDelaysGiveTheSameBytes) {
    auto o = poorDrive(3);
    o.frames = 60;
    const auto drive = makeDrive(o);
    const auto expected = run(drive, in(ObjectMode::Joint));
    EXPECT_GT(expected->statistics().jointAccepted, 0U);
    for (uint64_t seed = 0; seed < 2; ++seed) {
        // Each worker has its own thread, so its own random numbers.
        auto random = std::make_shared<std::map<std::string, djpete_test::Random>>();
        uint64_t n = 100 * seed;
        for (const char* w : {"backbone", "objects", "places", "full adjustment"})
            random->emplace(w, djpete_test::Random(++n));
        const auto delay = [random](const char* worker) {
            const double ms = random->at(worker).uniform(0, 20);
            std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
        };
        const auto threaded = run(drive, in(ObjectMode::Joint), Mode::Threaded, delay);
        EXPECT_TRUE(sameBytes(mapNumbers(threaded->map()), mapNumbers(expected->map()))) << seed;
    }
}

/// The problem around the end of a poor drive, and what of the map joins it.
struct JointProblem : testing::Test {
    SyntheticDrive drive = makeDrive(poorDrive(4));
    std::unique_ptr<MapKeeper> keeper = run(drive, in(ObjectMode::Worker));

    std::set<map::ObjectId> all() const {
        std::set<map::ObjectId> ids;
        for (const auto& [id, track] : keeper->map().objects()) ids.insert(id);
        return ids;
    }
    BackboneProblem problem(const map::SlamMap& map, const JointOptions& options = {}) const {
        auto p = backboneProblem(map, {}, 10);
        addObjects(map, all(), options, p);
        return p;
    }
};

TEST_F(JointProblem, holdsStandingWellKnownObjectsThatTwoCamerasSee) {
    const auto p = problem(keeper->map());
    ASSERT_FALSE(p.objects.empty());
    std::vector<std::set<std::size_t>> cameras(p.objects.size());
    std::vector<unsigned> edges(p.objects.size(), 0);
    for (const auto& e : p.objectEdges) {
        ++edges[e.object];
        if (e.camera) cameras[e.object].insert(*e.camera);
    }
    for (std::size_t i = 0; i < p.objects.size(); ++i) {
        const auto& track = keeper->map().objects().at(p.objects[i].id);
        EXPECT_FALSE(track.moving);
        EXPECT_GE(track.observations.size(), JointOptions().minObservations);
        EXPECT_EQ(edges[i], track.observations.size());
        EXPECT_GE(cameras[i].size(), 2U);
    }
    auto moving = keeper->map();
    auto track = moving.objects().at(p.objects.front().id);
    track.moving = true;
    moving.setObject(track);
    EXPECT_EQ(problem(moving).objects.size() + 1, p.objects.size());
}

TEST_F(JointProblem, leavesOutObjectsThatLandmarksLieOn) {
    auto map = keeper->map();
    const auto before = problem(map);
    ASSERT_FALSE(before.objects.empty());
    ASSERT_GT(before.points.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
        map.setLandmarkPosition(before.points[i].id, before.objects[0].T_world_obj.translation());
    const auto after = problem(map);
    EXPECT_EQ(after.objects.size() + 1, before.objects.size());
    EXPECT_NE(after.objects.empty() ? map::ObjectId{9999} : after.objects[0].id,
              before.objects[0].id);
}

TEST_F(JointProblem, neighboursInTimeCountAsFewer) {
    JointOptions alone, correlated;
    alone.correlation = 0;
    correlated.correlation = 0.5;
    correlated.correlatedFrames = 1;
    const auto a = problem(keeper->map(), alone), b = problem(keeper->map(), correlated);
    ASSERT_EQ(a.objectEdges.size(), b.objectEdges.size());
    double least = 1, most = 0;
    for (std::size_t i = 0; i < a.objectEdges.size(); ++i) {
        const double weight =
            b.objectEdges[i].information(0, 0) / a.objectEdges[i].information(0, 0);
        least = std::min(least, weight);
        most = std::max(most, weight);
    }
    // Two neighbours: 1 / (1 + 2 * 0.5); at the ends one: 1 / (1 + 0.5).
    EXPECT_NEAR(least, 0.5, 1e-9);
    EXPECT_NEAR(most, 1 / 1.5, 1e-9);
}

TEST_F(JointProblem, anotherSolveGivesTheSameBytesAndLeavesFixedCamerasAlone) {
    const auto p = problem(keeper->map());
    const auto one = solve(p, {}, {}), two = solve(p, {}, {});
    ASSERT_EQ(one.cameras.size(), two.cameras.size());
    ASSERT_FALSE(one.cameras.empty());
    for (std::size_t i = 0; i < one.cameras.size(); ++i)
        EXPECT_EQ(one.cameras[i].second.matrix(), two.cameras[i].second.matrix());
    EXPECT_NE(one.joint, JointOutcome::None);
}

}  // namespace
}  // namespace djpete::backend
