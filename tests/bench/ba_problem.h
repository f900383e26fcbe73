/// One local bundle adjustment, for our solver and for Ceres: the same residuals and analytic
/// Jacobians, the same kernel, the same start.
#pragma once

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "djpete/backend/backbone.h"
#include "djpete/geometry/residuals.h"

namespace djpete_bench {

using djpete::backend::BackboneOptions;
using djpete::backend::BackboneProblem;
using djpete::geometry::SE3;
using djpete::geometry::Vec2;
using djpete::geometry::Vec3;

/// Calls visit(residual, camera, point) for every observation, as the back end weighs them: mono
/// or stereo. (LiDAR depths and odometry between neighbours are left out.)
template <class Visit>
void forEachEdge(const BackboneProblem& in, Visit visit) {
    for (const auto& o : in.observations) {
        const auto& f = o.feature;
        const auto& camera = in.cameras[o.camera].camera;
        const double w = 1 / double(f.sigma_px);
        if (f.uRight_px && camera.hasRight()) {
            visit(djpete::geometry::StereoPointResidual(
                      camera, Vec3(double(f.u_px), double(f.v_px), double(*f.uRight_px)),
                      Vec3(w, w, 1 / double(f.uRightSigma_px))),
                  o.camera, o.point);
        } else {
            visit(djpete::geometry::MonoPointResidual(camera, Vec2(double(f.u_px), double(f.v_px)),
                                                      w),
                  o.camera, o.point);
        }
    }
}

inline djpete::solver::Problem ourProblem(const BackboneProblem& in, double huberScale) {
    djpete::solver::Problem problem;
    std::vector<djpete::solver::PoseId> poses;
    std::vector<djpete::solver::PointId> points;
    for (const auto& c : in.cameras) poses.push_back(problem.addPose(c.T_world_cam, c.fixed));
    for (const auto& p : in.points) points.push_back(problem.addPoint(p.p_world));
    forEachEdge(in, [&](const auto& residual, std::size_t camera, std::size_t point) {
        problem.add(residual, djpete::solver::RobustKernel::huber(huberScale), poses[camera],
                    points[point]);
    });
    return problem;
}

/// q (x, y, z, w), then t.
using CeresPose = std::array<double, 7>;

inline SE3 poseOf(const double* p) {
    return {Eigen::Map<const Eigen::Quaterniond>(p).toRotationMatrix(),
            Eigen::Map<const Vec3>(p + 4)};
}

inline void poseTo(const SE3& T, double* p) {
    Eigen::Map<Eigen::Quaterniond>(p).operator=(Eigen::Quaterniond(T.rotation()));
    Eigen::Map<Vec3> t(p + 4);
    t = T.translation();
}

/// T <- T exp(d). The cost functions give their Jacobians by d in the first six columns, so the
/// Jacobian of Plus is the identity over a row of zeros.
class RightPerturbation final : public ceres::Manifold {
  public:
    int AmbientSize() const override { return 7; }
    int TangentSize() const override { return 6; }
    bool Plus(const double* x, const double* d, double* xPlus) const override {
        poseTo(poseOf(x) * SE3::exp(Eigen::Map<const djpete::geometry::Vec6>(d)), xPlus);
        return true;
    }
    bool PlusJacobian(const double* /*x*/, double* J) const override {
        Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(J).setIdentity();
        return true;
    }
    bool Minus(const double* y, const double* x, double* d) const override {
        Eigen::Map<djpete::geometry::Vec6> out(d);
        out = (poseOf(x).inverse() * poseOf(y)).log();
        return true;
    }
    bool MinusJacobian(const double* /*x*/, double* J) const override {
        Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(J).setIdentity();
        return true;
    }
};

/// One of our residuals with its own Jacobians. A point behind the camera costs what it costs in
/// our solver.
template <class R>
class CeresEdge final : public ceres::SizedCostFunction<R::kDim, 7, 3> {
  public:
    explicit CeresEdge(const R& residual) : residual_(residual) {}
    bool Evaluate(double const* const* x, double* e, double** jacobians) const override {
        constexpr int kDim = R::kDim;
        const SE3 T = poseOf(x[0]);
        const Vec3 p = Eigen::Map<const Vec3>(x[1]);
        Eigen::Matrix<double, kDim, 6> J_cam;
        Eigen::Matrix<double, kDim, 3> J_point;
        const bool wantCam = jacobians && jacobians[0], wantPoint = jacobians && jacobians[1];
        const auto r = residual_(T, p, wantCam ? &J_cam : nullptr, wantPoint ? &J_point : nullptr);
        Eigen::Map<Eigen::Matrix<double, kDim, 1>> out(e);
        if (r) {
            out = *r;
        } else {
            out.setZero();
            out[0] = std::sqrt(djpete::solver::Options().invalidSquaredNorm);
            J_cam.setZero();
            J_point.setZero();
        }
        if (wantCam) {
            Eigen::Map<Eigen::Matrix<double, kDim, 7, Eigen::RowMajor>> J(jacobians[0]);
            J.template leftCols<6>() = J_cam;
            J.col(6).setZero();
        }
        if (wantPoint) {
            Eigen::Map<Eigen::Matrix<double, kDim, 3, Eigen::RowMajor>> J(jacobians[1]);
            J = J_point;
        }
        return true;
    }

  private:
    R residual_;
};

/// Owns what the Ceres problem points to.
struct CeresProblem {
    std::vector<CeresPose> poses;
    std::vector<Vec3> points;
    RightPerturbation manifold;
    std::unique_ptr<ceres::LossFunction> loss;
    std::unique_ptr<ceres::Problem> problem;

    CeresProblem(const BackboneProblem& in, double huberScale)
        : poses(in.cameras.size()), loss(new ceres::HuberLoss(huberScale)) {
        ceres::Problem::Options options;
        options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        options.disable_all_safety_checks = true;
        problem = std::make_unique<ceres::Problem>(options);
        for (const auto& p : in.points) points.push_back(p.p_world);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            poseTo(in.cameras[i].T_world_cam, poses[i].data());
            problem->AddParameterBlock(poses[i].data(), 7, &manifold);
            if (in.cameras[i].fixed) problem->SetParameterBlockConstant(poses[i].data());
        }
        forEachEdge(in, [&](const auto& residual, std::size_t camera, std::size_t point) {
            using R = std::decay_t<decltype(residual)>;
            problem->AddResidualBlock(new CeresEdge<R>(residual), loss.get(), poses[camera].data(),
                                      points[point].data());
        });
    }
    CeresProblem(const CeresProblem&) = delete;
    CeresProblem& operator=(const CeresProblem&) = delete;
    ~CeresProblem() = default;
};

}  // namespace djpete_bench
