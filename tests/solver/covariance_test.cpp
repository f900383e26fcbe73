/// Marginal covariances against closed forms and against the dense inverse.
#include <gtest/gtest.h>

#include "djpete_test/numeric_jacobian.h"
#include "djpete_test/street_problem.h"

namespace djpete::solver {
namespace {

using namespace djpete_test;
using namespace djpete::geometry;

TEST(Covariance, OfOnePriorIsTheInverseInformation) {
    Problem problem;
    const PoseId x = problem.addPose(SE3());
    const Vec6 sigma = (Vec6() << 0.1, 0.2, 0.3, 0.01, 0.02, 0.03).finished();
    problem.add(PosePriorResidual(SE3(), Mat6(sigma.cwiseInverse().asDiagonal())), x);
    const auto C = covariance(problem, x);
    ASSERT_TRUE(C);
    EXPECT_LT((*C - Mat6(sigma.cwiseAbs2().asDiagonal())).norm(), 1e-12);
}

TEST(Covariance, SpeaksInTheObjectsOwnFrame) {
    // Ten equal sightings with 0.3 m across the object's length: 0.3 / sqrt(10), whatever its
    // heading.
    Problem problem;
    const PoseId camera = problem.addPose(streetPose(3, 0.1) * opticalOnVehicle(), true);
    const SE3 T_world_obj = SE3::fromYaw(1.1, {12, 3, 0.5});
    const PoseId object = problem.addPose(T_world_obj);
    const Vec6 sigma = (Vec6() << 0.3, 0.1, 0.1, 0.01, 0.01, 0.05).finished();
    for (int k = 0; k < 10; ++k) {
        problem.add(CameraObjectResidual(problem.pose(camera).inverse() * T_world_obj,
                                         Mat6(sigma.cwiseInverse().asDiagonal())),
                    camera, object);
    }
    const auto C = covariance(problem, object);
    ASSERT_TRUE(C);
    EXPECT_LT((*C - Mat6((0.1 * sigma.cwiseAbs2()).asDiagonal())).norm(), 1e-12);
    EXPECT_FALSE(covariance(problem, camera));
}

TEST(Covariance, AddsUpAlongAChain) {
    for (int n : {5, 100}) {  // dense and sparse
        Problem problem;
        std::vector<PoseId> ids{problem.addPose(SE3(), true)};
        for (int i = 1; i <= n; ++i) {
            ids.push_back(problem.addPose(SE3()));
            problem.add(RelativePoseResidual(SE3(), Mat6::Identity()), ids[std::size_t(i) - 1],
                        ids[std::size_t(i)]);
        }
        const auto C = covariances(problem, ids);
        EXPECT_FALSE(C[0]);
        for (std::size_t i = 1; i < ids.size(); ++i) {
            ASSERT_TRUE(C[i]);
            EXPECT_LT((*C[i] - double(i) * Mat6::Identity()).norm(), 1e-8 * double(i));
        }
    }
}

TEST(Covariance, OfABundleIsTheBlockOfTheFullInverse) {
    StreetOptions few;
    few.cameras = 3;
    few.points = 25;
    few.sigma_px = 0.5;
    const StreetWorld world = makeStreet(few);
    StartOptions start;
    start.fixedCameras = 1;
    StreetProblem p = stereoProblem(world, start);
    solve(p.problem);
    // The full Hessian, points and all.
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(12 + 75, 12 + 75);
    for (const StereoObservation& z : world.observations) {
        Mat36 J_cam;
        Mat3 J_point;
        const PoseId c = p.cameras[std::size_t(z.camera)];
        StereoPointResidual(world.camera, z.uvu)(
            p.problem.pose(c), p.problem.point(p.points[std::size_t(z.point)]), &J_cam, &J_point);
        Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, 87);
        if (z.camera > 0) J.middleCols(6 * (z.camera - 1), 6) = J_cam;
        J.middleCols(12 + 3 * z.point, 3) = J_point;
        H += J.transpose() * J;
    }
    const Eigen::MatrixXd full = H.inverse();
    for (int c = 1; c < 3; ++c) {
        const auto C = covariance(p.problem, p.cameras[std::size_t(c)]);
        ASSERT_TRUE(C);
        const Mat6 expected = full.block<6, 6>(6 * (c - 1), 6 * (c - 1));
        EXPECT_LT((*C - expected).norm(), 1e-6 * expected.norm());
    }
}

TEST(Covariance, OfAFreeGaugeIsNothing) {
    Problem problem;
    const PoseId a = problem.addPose(SE3()), b = problem.addPose(SE3());
    problem.add(RelativePoseResidual(SE3(), Mat6::Identity()), a, b);
    EXPECT_FALSE(covariance(problem, a));
    StartOptions free;
    free.fixedCameras = 0;
    const StreetProblem p = stereoProblem(makeStreet({}), free);
    EXPECT_FALSE(covariance(p.problem, p.cameras[3]));
}

TEST(Covariance, OfATwist) {
    Problem problem;
    const VectorId v = problem.addVector6(Vec6::Zero());
    problem.add(VectorPriorResidual(Vec6::Zero(), 2 * Mat6::Identity()), v);
    const auto C = covariance(problem, v);
    ASSERT_TRUE(C);
    EXPECT_LT((*C - 0.25 * Mat6::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace djpete::solver
