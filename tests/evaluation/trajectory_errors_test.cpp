#include "djpete/evaluation/trajectory_errors.h"

#include "djpete/evaluation/alignment.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

const SE3 kSomewhere = SE3::exp((Vec6() << 10, -20, 30, 0.5, -1.0, 2.0).finished());

/// Straight along z, 1 m a frame.
Trajectory straightPath(std::size_t frames) {
    Trajectory path;
    for (std::size_t i = 0; i < frames; ++i) {
        path.push_back({Mat3::Identity(), Vec3(0, 0, static_cast<double>(i))});
    }
    return path;
}

}  // namespace

TEST(TrajectoryErrors, AreZeroForIdenticalPaths) {
    const auto path = windingPath(400);
    const auto e = evaluateTrajectory(path, path);
    EXPECT_EQ(e.frames, 400U);
    EXPECT_NEAR(e.ate_se3_m, 0, 1e-10);
    EXPECT_EQ(e.ate_unaligned_m, 0);
    EXPECT_NEAR(e.ate_sim3_m.value(), 0, 1e-10);
    EXPECT_NEAR(e.sim3_scale.value(), 1, 1e-12);
    EXPECT_NEAR(e.t_rel_percent.value(), 0, 1e-10);
    EXPECT_NEAR(e.r_rel_deg_per_100m.value(), 0, 1e-6);
    EXPECT_NEAR(e.rpe_m.value(), 0, 1e-10);
}

TEST(TrajectoryErrors, AlignmentFindsAKnownMotion) {
    const auto truth = windingPath(100);
    const auto estimate = movedBy(kSomewhere.inverse(), truth);
    const auto a = alignSe3(estimate, truth);
    EXPECT_LT((a.T_truth_estimate.matrix() - kSomewhere.matrix()).norm(), 1e-9);
    const auto e = evaluateTrajectory(estimate, truth);
    EXPECT_NEAR(e.ate_se3_m, 0, 1e-10);
    EXPECT_GT(e.ate_unaligned_m, 10);
}

TEST(TrajectoryErrors, DoNotChangeWhenEitherWorldMoves) {
    const auto truth = windingPath(500);
    Trajectory estimate = truth;
    for (std::size_t i = 0; i < estimate.size(); ++i) {
        const double s = static_cast<double>(i);
        estimate[i] = estimate[i] * SE3::exp((Vec6() << 0.3 * std::sin(s), 0.01 * s,
                                              0.2 * std::cos(s), 0, 1e-4 * s, 0)
                                                 .finished());
    }
    const auto plain = evaluateTrajectory(estimate, truth);
    EXPECT_GT(plain.ate_se3_m, 0.1);
    for (const auto& moved : {evaluateTrajectory(movedBy(kSomewhere, estimate), truth),
                              evaluateTrajectory(estimate, movedBy(kSomewhere, truth))}) {
        EXPECT_NEAR(moved.ate_se3_m, plain.ate_se3_m, 1e-9);
        EXPECT_NEAR(*moved.ate_sim3_m, *plain.ate_sim3_m, 1e-9);
        EXPECT_NEAR(*moved.sim3_scale, *plain.sim3_scale, 1e-12);
        EXPECT_NEAR(*moved.t_rel_percent, *plain.t_rel_percent, 1e-9);
        EXPECT_NEAR(*moved.r_rel_deg_per_100m, *plain.r_rel_deg_per_100m, 1e-9);
        EXPECT_NEAR(*moved.rpe_m, *plain.rpe_m, 1e-9);
    }
}

TEST(TrajectoryErrors, ScaleErrorIsDriftAndIsHiddenBySim3) {
    const auto truth = straightPath(300);
    Trajectory estimate = truth;
    for (auto& pose : estimate) pose.translation() *= 1.02;
    const auto e = evaluateTrajectory(estimate, truth);
    EXPECT_NEAR(e.sim3_scale.value(), 1 / 1.02, 1e-12);
    EXPECT_NEAR(e.ate_sim3_m.value(), 0, 1e-9);
    // Positions 0..299 times 0.02, about their mean: standard deviation of a uniform ladder.
    const double n = 300;
    EXPECT_NEAR(e.ate_se3_m, 0.02 * std::sqrt((n * n - 1) / 12), 1e-9);
    EXPECT_NEAR(e.ate_unaligned_m, 0.02 * std::sqrt((n - 1) * (2 * n - 1) / 6), 1e-9);
    // A sub-path ends at the first frame farther than its length: 101 m for 100 m, 201 m for 200 m.
    // Starts at 0, 10 .. 190 reach 101 m on; starts at 0 .. 90 reach 201 m (the last frame is 299).
    EXPECT_EQ(e.segments, 20U + 10U);
    EXPECT_NEAR(e.t_rel_percent.value(), 2.0 * (20 * 1.01 + 10 * 1.005) / 30, 1e-9);
    EXPECT_NEAR(e.r_rel_deg_per_100m.value(), 0, 1e-9);
    EXPECT_NEAR(e.rpe_m.value(), 0.02, 1e-12);
}

TEST(TrajectoryErrors, RotationDriftIsPerHundredMetres) {
    const auto truth = straightPath(150);
    Trajectory estimate = truth;  // turns 0.01 degree a metre about z without leaving the line
    for (std::size_t i = 0; i < estimate.size(); ++i) {
        const double angle = 0.01 * M_PI / 180 * static_cast<double>(i);
        estimate[i] = SE3::fromYaw(angle, truth[i].translation());
    }
    const auto e = evaluateTrajectory(estimate, truth);
    EXPECT_NEAR(e.r_rel_deg_per_100m.value(), 1.01, 1e-9);  // sub-paths are 101 m long
    EXPECT_NEAR(e.t_rel_percent.value(), 0, 1e-9);
    EXPECT_NEAR(e.rpe_deg.value(), 0.01, 1e-9);
}

TEST(TrajectoryErrors, ShortPathsHaveNoDrift) {
    const auto path = straightPath(101);  // 100 m exactly: no frame lies beyond
    const auto e = evaluateTrajectory(path, path);
    EXPECT_FALSE(e.t_rel_percent.has_value());
    EXPECT_FALSE(e.r_rel_deg_per_100m.has_value());
    EXPECT_EQ(e.segments, 0U);
    EXPECT_TRUE(evaluateTrajectory(straightPath(102), straightPath(102)).t_rel_percent);
}

TEST(TrajectoryErrors, StandingStillHasNoScale) {
    const auto truth = straightPath(10);
    const Trajectory still(10);
    for (const auto& e : {evaluateTrajectory(still, truth), evaluateTrajectory(truth, still),
                          evaluateTrajectory(still, still)}) {
        EXPECT_FALSE(e.sim3_scale.has_value());
        EXPECT_FALSE(e.ate_sim3_m.has_value());
        EXPECT_TRUE(std::isfinite(e.ate_se3_m));
    }
    const auto one = evaluateTrajectory(Trajectory(1), Trajectory(1));
    EXPECT_EQ(one.frames, 1U);
    EXPECT_EQ(one.ate_se3_m, 0);
    EXPECT_FALSE(one.rpe_m.has_value());
}

TEST(TrajectoryErrors, AMirroredPathIsNotAlignedAway) {
    const auto truth = windingPath(200);
    Trajectory mirrored = truth;
    for (auto& pose : mirrored) pose.translation().x() *= -1;
    const auto a = alignSe3(mirrored, truth);
    EXPECT_NEAR(a.T_truth_estimate.rotation().determinant(), 1, 1e-12);
    EXPECT_GT(evaluateTrajectory(mirrored, truth).ate_se3_m, 0.1);
}

TEST(TrajectoryErrors, LengthsMustAgree) {
    EXPECT_INPUT_ERROR(evaluateTrajectory(Trajectory(3), Trajectory(4)), "3", "4");
    EXPECT_INPUT_ERROR(evaluateTrajectory({}, {}), "at least one");
}
