/// Ceres as the judge: the same problem must end at the same cost.
#include <gtest/gtest.h>

#include "djpete_test/ceres_problem.h"

namespace djpete::solver {
namespace {

using namespace djpete_test;
using namespace djpete::geometry;

ceres::Solver::Summary solveCeres(ceres::Problem& problem) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = 300;
    options.function_tolerance = 1e-14;
    options.gradient_tolerance = 1e-12;
    options.parameter_tolerance = 1e-14;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary;
}

Options exact() {
    Options options;
    options.maxIterations = 300;
    options.functionTolerance = 1e-14;
    options.stepTolerance = 1e-14;
    return options;
}

void expectSameCost(const Report& ours, const ceres::Solver::Summary& theirs) {
    EXPECT_TRUE(ours.usable()) << ours.message;
    EXPECT_TRUE(theirs.IsSolutionUsable()) << theirs.BriefReport();
    EXPECT_GT(theirs.final_cost, 1.0);
    EXPECT_NEAR(ours.initialCost, theirs.initial_cost, 1e-9 * theirs.initial_cost);
    EXPECT_NEAR(ours.finalCost, theirs.final_cost, 1e-6 * theirs.final_cost);
}

TEST(AgainstCeres, StereoBundle) {
    StreetOptions o;
    o.sigma_px = 0.7;
    const StreetWorld world = makeStreet(o);
    StreetProblem ours = stereoProblem(world, {});
    CeresStreet theirs = ceresStereoProblem(world, {});
    expectSameCost(solve(ours.problem, exact()), solveCeres(*theirs.problem));
    for (std::size_t c = 0; c < ours.cameras.size(); ++c) {
        const Vec3 t(theirs.cameras[c][4], theirs.cameras[c][5], theirs.cameras[c][6]);
        EXPECT_LT((ours.problem.pose(ours.cameras[c]).translation() - t).norm(), 1e-5);
    }
}

StreetWorld outlierStreet() {
    StreetOptions o;
    o.sigma_px = 0.5;
    o.outliers = 0.05;
    return makeStreet(o);
}

/// Near enough that both end in the same basin.
StartOptions nearStart() {
    StartOptions o;
    o.camera_m = 0.02;
    o.camera_rad = 0.001;
    o.point_m = 0.05;
    return o;
}

TEST(AgainstCeres, StereoBundleWithHuberAndOutliers) {
    const StreetWorld world = outlierStreet();
    StreetProblem ours = stereoProblem(world, nearStart(), RobustKernel::huber(1.5));
    CeresStreet theirs = ceresStereoProblem(
        world, nearStart(), +[]() -> ceres::LossFunction* { return new ceres::HuberLoss(1.5); });
    expectSameCost(solve(ours.problem, exact()), solveCeres(*theirs.problem));
}

TEST(AgainstCeres, StereoBundleWithCauchyAndOutliers) {
    const StreetWorld world = outlierStreet();
    StreetProblem ours = stereoProblem(world, nearStart(), RobustKernel::cauchy(2));
    CeresStreet theirs = ceresStereoProblem(
        world, nearStart(), +[]() -> ceres::LossFunction* { return new ceres::CauchyLoss(2); });
    expectSameCost(solve(ours.problem, exact()), solveCeres(*theirs.problem));
}

/// W log(Z^-1 T_cam^-1 T_obj) with a logarithm of its own, through the half angle.
struct CeresCameraObject {
    Eigen::Quaterniond q_measured;
    Vec3 t_measured;
    Mat6 W;

    template <class T>
    bool operator()(const T* cam, const T* obj, T* e) const {
        using Vec = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<T>> qc(cam), qo(obj);
        const Eigen::Map<const Vec> tc(cam + 4), to(obj + 4);
        const Eigen::Quaternion<T> qz = q_measured.cast<T>();
        Eigen::Quaternion<T> q = qz.conjugate() * (qc.conjugate() * qo);
        const Vec t = qz.conjugate() * Vec(qc.conjugate() * Vec(to - tc) - t_measured.cast<T>());
        if (q.w() < T(0)) q.coeffs() = -q.coeffs();
        const T sine = sqrt(q.vec().squaredNorm() + T(1e-30));
        const T half = atan2(sine, q.w());
        const Vec phi = (T(2) * half / sine) * q.vec();
        // V^-1 t = t - phi x t / 2 + (1 - half cot half) / theta^2 phi x (phi x t)
        const T k = (T(1) - half * q.w() / sine) / (T(4) * half * half);
        const Vec cross = phi.cross(t);
        Eigen::Matrix<T, 6, 1> xi;
        xi << t - T(0.5) * cross + k * phi.cross(cross), phi;
        Eigen::Map<Eigen::Matrix<T, 6, 1>> out(e);
        out = W.cast<T>() * xi;
        return true;
    }
};

TEST(AgainstCeres, CamerasAndObjectsOnSE3) {
    std::mt19937 rng(9);
    Problem problem;
    std::vector<PoseId> poses;
    std::vector<CeresPose> blocks;
    const int numCameras = 6, numObjects = 8;
    std::vector<SE3> truth;
    for (int i = 0; i < numCameras; ++i)
        truth.push_back(streetPose(2 * i, 0.03) * opticalOnVehicle());
    for (int j = 0; j < numObjects; ++j) {
        truth.push_back(streetPose(2 * j, 0.03) *
                        SE3::fromYaw(0.4 * j, {3, j % 2 ? 3.0 : -3.0, 0.8}));
    }
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const SE3 start = i ? truth[i] * SE3::exp(gaussianTwist(rng, 0.3, 0.1)) : truth[i];
        poses.push_back(problem.addPose(start, i == 0));
        blocks.push_back(toCeres(start));
    }
    ceres::Problem theirs;
    for (auto& b : blocks) theirs.AddParameterBlock(b.data(), 7, ceresPoseManifold());
    theirs.SetParameterBlockConstant(blocks[0].data());
    Mat6 information = Vec6(1, 2, 3, 40, 50, 60).asDiagonal();
    information(0, 4) = information(4, 0) = 3;
    const Mat6 W = *sqrtInformation<6>(information);
    for (std::size_t i = 0; i < std::size_t(numCameras); ++i) {
        for (std::size_t j = std::size_t(numCameras); j < truth.size(); ++j) {
            const SE3 Z = truth[i].inverse() * truth[j] * SE3::exp(gaussianTwist(rng, 0.4, 0.15));
            problem.add(CameraObjectResidual(Z, W), RobustKernel::huber(2), poses[i], poses[j]);
            theirs.AddResidualBlock(
                new ceres::AutoDiffCostFunction<CeresCameraObject, 6, 7, 7>(
                    new CeresCameraObject{Eigen::Quaterniond(Z.rotation()), Z.translation(), W}),
                new ceres::HuberLoss(2), blocks[i].data(), blocks[j].data());
        }
    }
    expectSameCost(solve(problem, exact()), solveCeres(theirs));
}

}  // namespace
}  // namespace djpete::solver
