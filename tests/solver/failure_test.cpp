/// What must not break the solver.
#include <gtest/gtest.h>

#include <limits>

#include "djpete_test/street_problem.h"

namespace djpete::solver {
namespace {

using namespace djpete_test;
using namespace djpete::geometry;

const double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Failure, EmptyProblemSaysSo) {
    Problem problem;
    EXPECT_EQ(solve(problem).status, Status::NothingToSolve);
    problem.addPose(SE3());
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::NothingToSolve);
    EXPECT_EQ(report.message, "there is no residual");
    EXPECT_FALSE(report.usable());
}

TEST(Failure, NothingFreeSaysSoAndStillGivesTheCost) {
    Problem problem;
    const PoseId x = problem.addPose(SE3(Mat3::Identity(), {1, 0, 0}), true);
    problem.add(PosePriorResidual(SE3(), Mat6::Identity()), x);
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::NothingToSolve);
    EXPECT_DOUBLE_EQ(report.finalCost, 0.5);
    EXPECT_EQ(problem.pose(x).translation(), Vec3(1, 0, 0));
}

TEST(Failure, NaNInAVariableIsNamedAndNothingMoves) {
    const StreetWorld world = makeStreet({});
    StreetProblem p = stereoProblem(world, {});
    const SE3 before = p.problem.pose(p.cameras[5]);
    p.problem.set(p.points[3], Vec3(0, kNaN, 1));
    const Report report = solve(p.problem);
    EXPECT_EQ(report.status, Status::InvalidInput);
    EXPECT_EQ(report.message, "point number 3 is not finite");
    EXPECT_TRUE(p.problem.pose(p.cameras[5]).translation() == before.translation());
}

TEST(Failure, NaNInAMeasurementIsNamedAndNothingMoves) {
    const StreetWorld world = makeStreet({});
    StreetProblem p = stereoProblem(world, {});
    const SE3 before = p.problem.pose(p.cameras[5]);
    const ResidualId bad =
        p.problem.add(StereoPointResidual(world.camera, {kNaN, 1, 2}), p.cameras[5], p.points[0]);
    const Report report = solve(p.problem);
    EXPECT_EQ(report.status, Status::InvalidInput);
    EXPECT_EQ(report.message,
              "StereoPointResidual number " + std::to_string(bad.entry) + " is not finite");
    EXPECT_TRUE(p.problem.pose(p.cameras[5]).translation() == before.translation());
    EXPECT_TRUE(p.problem.pose(p.cameras[5]).rotation() == before.rotation());
}

/// Finite, but with a Jacobian that is not.
struct BrokenJacobian {
    static constexpr int kDim = 6;
    static constexpr const char* kName = "BrokenJacobian";
    Vec6 operator()(const Vec6& x, Mat6* J = nullptr) const {
        if (J) J->setConstant(std::numeric_limits<double>::quiet_NaN());
        return x;
    }
};

TEST(Failure, NaNInAJacobianNeverComesOut) {
    Problem problem;
    const VectorId x = problem.addVector6(Vec6::Ones());
    problem.add(BrokenJacobian{}, x);
    const Report report = solve(problem);
    EXPECT_NE(report.status, Status::Converged);
    EXPECT_TRUE(problem.vector6(x) == Vec6(Vec6::Ones()));
}

TEST(Failure, EveryPointBehindTheCameraSaysSo) {
    Problem problem;
    const PoseId camera = problem.addPose(SE3());
    const PointId point = problem.addPoint({0, 0, -3});
    problem.add(StereoPointResidual(kittiLikeCamera(), {1, 2, 3}), camera, point);
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::NothingToSolve);
    EXPECT_EQ(report.numInvalid, 1);
}

TEST(Failure, NoGaugeIsSurvived) {
    // All cameras free: 6 directions have no information at all.
    StreetOptions noisy;
    noisy.sigma_px = 0.5;
    const StreetWorld world = makeStreet(noisy);
    StartOptions free;
    free.fixedCameras = 0;
    StreetProblem p = stereoProblem(world, free), fixed = stereoProblem(world, {});
    const Report report = solve(p.problem);
    EXPECT_TRUE(report.usable()) << report.message;
    EXPECT_LT(report.finalCost, solve(fixed.problem).finalCost);
    for (PoseId id : p.cameras) EXPECT_TRUE(p.problem.pose(id).matrix().allFinite());
}

TEST(Failure, PointSeenOnceByOneCameraIsSurvived) {
    // Depth is free: the pixel is met, the point stays near its start.
    Problem problem;
    const StereoCamera camera = kittiLikeCamera();
    const PoseId pose = problem.addPose(SE3(), true);
    const PointId point = problem.addPoint({0.5, 0.1, 10});
    problem.add(MonoPointResidual(camera, {650, 190}), pose, point);
    const Report report = solve(problem);
    EXPECT_TRUE(report.usable());
    EXPECT_LT(report.finalCost, 1e-10);
    EXPECT_LT((problem.point(point) - Vec3(0.5, 0.1, 10)).norm(), 1);
    // And with the camera free as well.
    problem.setConstant(pose, false);
    problem.set(point, Vec3(0.5, 0.1, 10));
    EXPECT_LT(solve(problem).finalCost, 1e-10);
}

TEST(Failure, HopelessStartNeverGetsWorse) {
    const StreetWorld world = makeStreet({});
    StartOptions wild;
    wild.camera_m = 20;
    wild.camera_rad = 1;
    wild.point_m = 20;
    StreetProblem p = stereoProblem(world, wild);
    const Report report = solve(p.problem);
    EXPECT_LE(report.finalCost, report.initialCost);
    for (PoseId id : p.cameras) EXPECT_TRUE(p.problem.pose(id).matrix().allFinite());
    for (PointId id : p.points) EXPECT_TRUE(p.problem.point(id).allFinite());
}

TEST(Failure, ForeignAndRepeatedVariablesAreRefused) {
    Problem problem;
    const PoseId a = problem.addPose(SE3());
    const RelativePoseResidual r(SE3(), Mat6::Identity());
    EXPECT_THROW(problem.add(r, a, PoseId{1}), std::invalid_argument);
    EXPECT_THROW(problem.add(r, a, PoseId{}), std::invalid_argument);
    EXPECT_THROW(problem.add(r, a, a), std::invalid_argument);
    EXPECT_EQ(problem.numResiduals(), 0);
}

TEST(Failure, IterationsEndWithTheBestValues) {
    const StreetWorld world = makeStreet({});
    StreetProblem p = stereoProblem(world, {});
    Options two;
    two.maxIterations = 2;
    const Report report = solve(p.problem, two);
    EXPECT_EQ(report.status, Status::MaxIterations);
    EXPECT_EQ(report.iterations, 2);
    EXPECT_LT(report.finalCost, 0.1 * report.initialCost);
}

}  // namespace
}  // namespace djpete::solver
