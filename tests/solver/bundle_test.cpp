/// Bundle adjustment on the synthetic street.
#include <gtest/gtest.h>

#include <cstring>

#include "djpete_test/street_problem.h"

namespace djpete::solver {
namespace {

using namespace djpete_test;
using geometry::DepthPointResidual;
using geometry::MonoPointResidual;
using geometry::StereoPointResidual;

template <class T>
bool sameBytes(const T& a, const T& b) {
    return std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}
bool sameBytes(const SE3& a, const SE3& b) {
    return sameBytes(a.rotation(), b.rotation()) && sameBytes(a.translation(), b.translation());
}

TEST(Bundle, StereoFindsTheTruthWithoutNoise) {
    const StreetWorld world = makeStreet({});
    StreetProblem p = stereoProblem(world, {});
    const double before = worstCamera_m(p, world);
    const Report report = solve(p.problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    EXPECT_GT(before, 0.05);
    EXPECT_LT(worstCamera_m(p, world), 1e-7);
    EXPECT_LT(worstPoint_m(p, world), 1e-4);
    EXPECT_LT(report.finalCost, 1e-9);
    EXPECT_GT(report.initialCost, 1e5);
    EXPECT_EQ(report.numResiduals, int(world.observations.size()));
    EXPECT_EQ(report.numInvalid, 0);
}

TEST(Bundle, FarStartConvergesToo) {
    const StreetWorld world = makeStreet({});
    StartOptions far;
    far.camera_m = 0.5;
    far.camera_rad = 0.05;
    far.point_m = 1;
    StreetProblem p = stereoProblem(world, far);
    const Report report = solve(p.problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    EXPECT_LT(worstCamera_m(p, world), 1e-6);
}

TEST(Bundle, MonoWithLidarDepthFindsTheTruth) {
    const StreetWorld world = makeStreet({});
    const StreetStart start = disturbed(world, {});
    Problem problem;
    std::vector<PoseId> cameras;
    for (const SE3& T : start.T_world_cam) cameras.push_back(problem.addPose(T, cameras.empty()));
    std::vector<PointId> points;
    for (const Vec3& p : start.p_world) points.push_back(problem.addPoint(p));
    for (std::size_t k = 0; k < world.observations.size(); ++k) {
        const StereoObservation& z = world.observations[k];
        const PoseId camera = cameras[std::size_t(z.camera)];
        const PointId point = points[std::size_t(z.point)];
        if (k % 3 == 0) {
            const double depth = (world.T_world_cam[std::size_t(z.camera)].inverse() *
                                  world.p_world[std::size_t(z.point)])
                                     .z();
            problem.add(DepthPointResidual(world.camera, z.uvu.head<2>(), depth, 0.05), camera,
                        point);
        } else {
            problem.add(MonoPointResidual(world.camera, z.uvu.head<2>()), camera, point);
        }
    }
    const Report report = solve(problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
        EXPECT_LT(
            (problem.pose(cameras[c]).translation() - world.T_world_cam[c].translation()).norm(),
            1e-6);
    }
}

TEST(Bundle, NoiseIsAveragedDown) {
    StreetOptions noisy;
    noisy.sigma_px = 0.5;
    const StreetWorld world = makeStreet(noisy);
    StreetProblem p = stereoProblem(world, {});
    const Report report = solve(p.problem);
    EXPECT_EQ(report.status, Status::Converged);
    EXPECT_LT(worstCamera_m(p, world), 0.05);
    // Expected cost: half of sigma^2 times the degrees of freedom left.
    const double left = 3.0 * double(world.observations.size()) -
                        3.0 * double(world.p_world.size()) -
                        6.0 * double(world.T_world_cam.size() - 2);
    EXPECT_NEAR(report.finalCost / (0.5 * 0.25 * left), 1.0, 0.1);
}

TEST(Bundle, ConstantVariablesStayBitIdentical) {
    StreetOptions noisy;
    noisy.sigma_px = 1;
    const StreetWorld world = makeStreet(noisy);
    StreetProblem p = stereoProblem(world, {});
    for (std::size_t k = 0; k < p.points.size(); k += 3) p.problem.setConstant(p.points[k]);
    const detail::Values before = p.problem.values();
    ASSERT_LT(solve(p.problem).finalCost, 1e7);
    for (PoseId id : {p.cameras[0], p.cameras[1]}) {
        EXPECT_TRUE(sameBytes(p.problem.pose(id), before.poses[std::size_t(id.index)]));
    }
    for (std::size_t k = 0; k < p.points.size(); ++k) {
        EXPECT_EQ(sameBytes(p.problem.point(p.points[k]), before.points[k]), k % 3 == 0) << k;
    }
}

TEST(Bundle, PointsAloneAndCamerasAloneAreSolvedToo) {
    const StreetWorld world = makeStreet({});
    StartOptions camerasTrue;
    camerasTrue.fixedCameras = 10;
    StreetProblem structureOnly = stereoProblem(world, camerasTrue);
    EXPECT_EQ(solve(structureOnly.problem).status, Status::Converged);
    EXPECT_LT(worstPoint_m(structureOnly, world), 1e-4);

    StartOptions pointsTrue;
    pointsTrue.point_m = 0;
    pointsTrue.fixedCameras = 0;
    StreetProblem motionOnly = stereoProblem(world, pointsTrue);
    for (PointId id : motionOnly.points) motionOnly.problem.setConstant(id);
    EXPECT_EQ(solve(motionOnly.problem).status, Status::Converged);
    EXPECT_LT(worstCamera_m(motionOnly, world), 1e-7);
}

TEST(Bundle, SparseAndDenseReducedSystemsAgree) {
    StreetOptions o;
    o.sigma_px = 0.5;
    o.cameras = 30;
    o.maxDepth_m = 15;
    const StreetWorld world = makeStreet(o);
    Options dense, sparse;
    sparse.denseUpTo = 0;
    StreetProblem a = stereoProblem(world, {}), b = stereoProblem(world, {});
    const Report ra = solve(a.problem, dense), rb = solve(b.problem, sparse);
    EXPECT_EQ(ra.iterations, rb.iterations);
    EXPECT_NEAR(ra.finalCost, rb.finalCost, 1e-9 * ra.finalCost);
    for (std::size_t c = 0; c < a.cameras.size(); ++c) {
        EXPECT_LT(
            (a.problem.pose(a.cameras[c]).matrix() - b.problem.pose(b.cameras[c]).matrix()).norm(),
            1e-9);
    }
}

TEST(Bundle, TwoRunsGiveTheSameBytes) {
    StreetOptions o;
    o.sigma_px = 1;
    o.outliers = 0.1;
    const StreetWorld world = makeStreet(o);
    for (int denseUpTo : {60, 0}) {
        Options options;
        options.denseUpTo = denseUpTo;
        StreetProblem a = stereoProblem(world, {}, RobustKernel::huber(2));
        StreetProblem b = stereoProblem(world, {}, RobustKernel::huber(2));
        EXPECT_EQ(solve(a.problem, options).finalCost, solve(b.problem, options).finalCost);
        for (std::size_t c = 0; c < a.cameras.size(); ++c) {
            EXPECT_TRUE(sameBytes(a.problem.pose(a.cameras[c]), b.problem.pose(b.cameras[c])));
        }
        for (std::size_t k = 0; k < a.points.size(); ++k) {
            EXPECT_TRUE(sameBytes(a.problem.point(a.points[k]), b.problem.point(b.points[k])));
        }
    }
}

TEST(Bundle, PointBehindTheCameraCostsAFixedPenaltyAndHoldsUpNobody) {
    const StreetWorld world = makeStreet({});
    StreetProblem p = stereoProblem(world, {});
    const Vec3 behind = world.T_world_cam[5] * Vec3(0, 0, -10);
    const PointId lost = p.problem.addPoint(behind);
    const ResidualId r =
        p.problem.add(StereoPointResidual(world.camera, {600, 180, 580}), p.cameras[5], lost);
    const Report report = solve(p.problem);
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    EXPECT_EQ(report.numInvalid, 1);
    EXPECT_NEAR(report.finalCost, 0.5 * Options().invalidSquaredNorm, 1e-6);
    EXPECT_LT(worstCamera_m(p, world), 1e-6);
    EXPECT_FALSE(p.problem.squaredNorm(r));
    EXPECT_TRUE(p.problem.point(lost) == behind);
}

TEST(Bundle, DisabledResidualsAreNotThere) {
    StreetOptions o;
    o.outliers = 0.1;
    const StreetWorld world = makeStreet(o);
    StreetProblem p = stereoProblem(world, {});
    int kept = 0;
    for (std::size_t k = 0; k < p.residuals.size(); ++k) {
        p.problem.setEnabled(p.residuals[k], !world.observations[k].outlier);
        kept += !world.observations[k].outlier;
    }
    const Report report = solve(p.problem);
    EXPECT_EQ(report.numResiduals, kept);
    EXPECT_LT(report.finalCost, 1e-9);
    EXPECT_LT(worstCamera_m(p, world), 1e-6);
}

}  // namespace
}  // namespace djpete::solver
