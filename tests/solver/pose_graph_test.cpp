/// Problems without points: pose graphs, objects with cameras fixed, motion.
#include <gtest/gtest.h>

#include <random>

#include "djpete/geometry/residuals.h"
#include "djpete/solver/solve.h"
#include "djpete_test/synthetic_world.h"

namespace djpete::solver {
namespace {

using namespace djpete_test;
using namespace djpete::geometry;

/// A closed loop of `n` poses with exact odometry and loop edges, started disturbed.
struct Loop {
    Problem problem;
    std::vector<PoseId> ids;
    std::vector<SE3> truth;
    double worst_m() const {
        double worst = 0;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            worst = std::max(worst,
                             (problem.pose(ids[i]).translation() - truth[i].translation()).norm());
        }
        return worst;
    }
};

Loop makeLoop(int n) {
    Loop loop;
    std::mt19937 rng(3);
    for (int i = 0; i < n; ++i) {
        loop.truth.push_back(streetPose(i, 2 * M_PI / n));
        const SE3 start =
            loop.truth.back() * SE3::exp(gaussianTwist(rng, i ? 0.3 : 0, i ? 0.05 : 0));
        loop.ids.push_back(loop.problem.addPose(start, i == 0));
    }
    for (int i = 0; i < n; ++i) {
        for (int step : {1, 7}) {
            const auto a = std::size_t(i), b = std::size_t((i + step) % n);
            loop.problem.add(RelativePoseResidual(loop.truth[a].inverse() * loop.truth[b],
                                                  10 * Mat6::Identity()),
                             loop.ids[a], loop.ids[b]);
        }
    }
    return loop;
}

TEST(PoseGraph, LoopIsClosedDenselyAndSparsely) {
    for (int n : {20, 300}) {
        Loop loop = makeLoop(n);
        EXPECT_GT(loop.worst_m(), 0.3);
        const Report report = solve(loop.problem);
        EXPECT_EQ(report.status, Status::Converged) << report.message;
        EXPECT_LT(loop.worst_m(), 1e-6) << n;
        EXPECT_LT(report.iterations, 15);
    }
}

TEST(PoseGraph, InformationCountsWhenAStepIsJudged) {
    // x = 0 with information 100, x = 10 with 0.01, start 5: chi2 is 1.0 near x = 0.001. An
    // optimiser that judges steps by the unweighted error stays at 5 with chi2 2500.
    Problem problem;
    const PoseId origin = problem.addPose(SE3(), true);
    const PoseId x = problem.addPose(SE3(Mat3::Identity(), {5, 0, 0}));
    problem.add(RelativePoseResidual(SE3(), 10 * Mat6::Identity()), origin, x);
    problem.add(RelativePoseResidual(SE3(Mat3::Identity(), {10, 0, 0}), 0.1 * Mat6::Identity()),
                origin, x);
    const Report report = solve(problem);
    EXPECT_NEAR(problem.pose(x).translation().x(), 10 * 0.01 / 100.01, 1e-6);
    EXPECT_NEAR(2 * report.finalCost, 0.9999, 1e-4);
}

TEST(PoseGraph, InformationIsMeantPerAxis) {
    // High information of one rotation axis pins that axis and no other.
    for (int axis = 3; axis < 6; ++axis) {
        Problem problem;
        const PoseId origin = problem.addPose(SE3(), true);
        const PoseId x = problem.addPose(SE3());
        Vec6 weights = Vec6::Ones();
        weights[axis] = 100;
        Vec6 turned = Vec6::Zero();
        turned.tail<3>() << 0.1, 0.1, 0.1;
        problem.add(RelativePoseResidual(SE3(), Mat6(weights.asDiagonal())), origin, x);
        problem.add(RelativePoseResidual(SE3::exp(turned), Mat6(Mat6::Identity())), origin, x);
        solve(problem);
        const Vec6 xi = problem.pose(x).log();
        for (int k = 3; k < 6; ++k) EXPECT_NEAR(xi[k], k == axis ? 0 : 0.05, 2e-3) << axis << k;
    }
}

TEST(PoseGraph, DisconnectedNodesNeitherDisturbNorMove) {
    Problem problem;
    const PoseId a = problem.addPose(SE3(), true);
    const PoseId b = problem.addPose(SE3(Mat3::Identity(), {1, 0, 0}));
    const SE3 far(Mat3::Identity(), {7, 8, 9});
    const PoseId alone = problem.addPose(far);
    // Two nodes that see each other, but nothing that is fixed.
    const PoseId c = problem.addPose(SE3(Mat3::Identity(), {20, 0, 0}));
    const PoseId d = problem.addPose(SE3(Mat3::Identity(), {22, 0, 0}));
    const SE3 Z(Mat3::Identity(), {1.1, 0, 0});
    problem.add(RelativePoseResidual(Z, Mat6::Identity()), a, b);
    problem.add(RelativePoseResidual(Z, Mat6::Identity()), c, d);
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    EXPECT_NEAR(problem.pose(b).translation().x(), 1.1, 1e-8);
    EXPECT_NEAR((problem.pose(c).inverse() * problem.pose(d)).translation().x(), 1.1, 1e-8);
    EXPECT_TRUE(problem.pose(alone).translation() == far.translation());
}

TEST(Objects, FixedCamerasPlaceObjectsAtTheWeightedMean) {
    std::mt19937 rng(5);
    Problem problem;
    std::vector<PoseId> cameras;
    for (int i = 0; i < 10; ++i) {
        cameras.push_back(problem.addPose(streetPose(i, 0.02) * opticalOnVehicle(), true));
    }
    const Mat6 W = Vec6(1 / 0.3, 1 / 0.3, 1 / 0.3, 20, 20, 11.5).asDiagonal();
    std::vector<PoseId> objects;
    std::vector<SE3> truth;
    for (int j = 0; j < 100; ++j) {
        const SE3 T = streetPose(j % 20, 0.02) * SE3::fromYaw(0.1 * j, {5, 4.0 - j % 9, 0.8});
        truth.push_back(T);
        for (int i = 0; i < 10; ++i) {
            const SE3 T_cam_obj = problem.pose(cameras[std::size_t(i)]).inverse() * T;
            const SE3 Z = T_cam_obj * SE3::exp(gaussianTwist(rng, 0.3, 0.05));
            if (i == 0) objects.push_back(problem.addPose(problem.pose(cameras[0]) * Z));
            problem.add(CameraObjectResidual(Z, W), RobustKernel::cauchy(5),
                        cameras[std::size_t(i)], objects.back());
        }
    }
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    double mean = 0;
    for (std::size_t j = 0; j < objects.size(); ++j) {
        mean += (problem.pose(objects[j]).translation() - truth[j].translation()).norm() / 100;
    }
    // 0.3 m per axis over 10 sightings: 0.3 / sqrt(10) * sqrt(8 / pi) = 0.151 m.
    EXPECT_LT(mean, 0.18);
    EXPECT_GT(mean, 0.10);
}

TEST(Objects, ConstantVelocityFindsTheTwist) {
    Vec6 v;
    v << 8, 0.1, 0, 0, 0, 0.3;
    Problem problem;
    const PoseId camera = problem.addPose(opticalOnVehicle(), true);
    const VectorId twist = problem.addVector6(Vec6::Zero());
    std::mt19937 rng(6);
    std::vector<PoseId> poses;
    for (int k = 0; k < 10; ++k) {
        const SE3 T = SE3::fromYaw(0.2, {10, 3, 0}) * SE3::exp(0.1 * k * v);
        poses.push_back(problem.addPose(T * SE3::exp(gaussianTwist(rng, 0.2, 0.05))));
        problem.add(CameraObjectResidual(problem.pose(camera).inverse() * T, Mat6::Identity()),
                    camera, poses.back());
        if (k == 0) continue;
        problem.add(ConstantVelocityResidual(0.1, 10 * Mat6::Identity()), poses[std::size_t(k) - 1],
                    twist, poses[std::size_t(k)]);
    }
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    EXPECT_LT((problem.vector6(twist) - v).norm(), 1e-6);
}

TEST(Objects, TwistsThatChangeSlowlyFollowPriorAndDifference) {
    Problem problem;
    const VectorId a = problem.addVector6(Vec6::Zero()), b = problem.addVector6(Vec6::Ones());
    problem.add(VectorPriorResidual(Vec6::Constant(3), Mat6::Identity()), a);
    problem.add(VectorPriorResidual(Vec6::Constant(6), Mat6::Identity()), b);
    problem.add(TwistDifferenceResidual(Mat6::Identity()), a, b);
    EXPECT_EQ(solve(problem).status, Status::Converged);
    EXPECT_LT((problem.vector6(a) - Vec6::Constant(4)).norm(), 1e-6);
    EXPECT_LT((problem.vector6(b) - Vec6::Constant(5)).norm(), 1e-6);
}

}  // namespace
}  // namespace djpete::solver
