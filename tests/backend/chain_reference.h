/// The problem of motion_chain.h written down a second time, for the general solver.
#pragma once

#include <unsupported/Eigen/KroneckerProduct>
#include <vector>

#include "djpete/backend/motion_chain.h"
#include "djpete/geometry/information.h"
#include "djpete/geometry/pose_residuals.h"
#include "djpete/solver/solve.h"
#include "djpete_test/numeric_jacobian.h"
#include "djpete_test/random.h"

namespace djpete_test {

using djpete::backend::ChainNode;
using djpete::backend::ChainOptions;
using djpete::backend::MotionPrior;
using djpete::geometry::Mat6;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using djpete::geometry::Vec6;

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using Mat126 = Eigen::Matrix<double, 12, 6>;

/// White noise on acceleration between two nodes, whitened by the Cholesky factor of the whole
/// inverse of Q. Its Jacobians are central differences.
class WhiteNoiseResidual {
  public:
    static constexpr int kDim = 12;
    static constexpr const char* kName = "WhiteNoiseResidual";

    WhiteNoiseResidual(double dt_s, const Vec6& twistWalk) : dt_s_(dt_s) {
        const double t2 = dt_s * dt_s;
        const Eigen::Matrix2d inTime =
            (Eigen::Matrix2d() << t2 * dt_s / 3, t2 / 2, t2 / 2, dt_s).finished();
        const Mat6 walk = twistWalk.cwiseAbs2().asDiagonal();
        const Mat12 Q = Eigen::kroneckerProduct(inTime, walk);
        whitening_ = *djpete::geometry::sqrtInformation<12>(Mat12(Q.inverse()));
    }

    Vec12 operator()(const SE3& T, const Vec6& w, const SE3& U, const Vec6& v,
                     Mat126* J_T = nullptr, Mat126* J_w = nullptr, Mat126* J_U = nullptr,
                     Mat126* J_v = nullptr) const {
        using Twist = Eigen::Matrix<double, 6, 1>;
        if (J_T) *J_T = numericJacobian<12>([&](const SE3& x) { return error(x, w, U, v); }, T);
        if (J_w)
            *J_w = numericJacobian<12, 6>([&](const Twist& x) { return error(T, x, U, v); }, w);
        if (J_U) *J_U = numericJacobian<12>([&](const SE3& x) { return error(T, w, x, v); }, U);
        if (J_v)
            *J_v = numericJacobian<12, 6>([&](const Twist& x) { return error(T, w, U, x); }, v);
        return error(T, w, U, v);
    }

  private:
    Vec12 error(const SE3& T, const Vec6& w, const SE3& U, const Vec6& v) const {
        Vec12 e;
        e << (SE3::exp(-dt_s_ * w) * T.inverse() * U).log(), v - w;
        return whitening_ * e;
    }

    double dt_s_;
    Mat12 whitening_;
};

/// A twist is about zero.
class TwistResidual {
  public:
    static constexpr int kDim = 6;
    static constexpr const char* kName = "TwistResidual";
    explicit TwistResidual(const Vec6& sigma) : weight_(sigma.cwiseInverse()) {}
    Vec6 operator()(const Vec6& w, Mat6* J = nullptr) const {
        if (J) *J = weight_.asDiagonal();
        return weight_.cwiseProduct(w);
    }

  private:
    Vec6 weight_;
};

/// The chain as a problem of the general solver.
struct ReferenceChain {
    djpete::solver::Problem problem;
    std::vector<djpete::solver::PoseId> poses;
    std::vector<djpete::solver::VectorId> twists;

    ReferenceChain(const std::vector<ChainNode>& nodes, const MotionPrior& prior,
                   const djpete::solver::RobustKernel& kernel) {
        using djpete::geometry::PosePriorResidual;
        for (const auto& node : nodes) {
            poses.push_back(problem.addPose(node.T_world_obj));
            twists.push_back(problem.addVector6(node.twist));
            problem.add(TwistResidual(prior.twistSigma), twists.back());
            for (const auto& m : node.measured) {
                const auto W = *djpete::geometry::sqrtInformation<6>(m.information);
                problem.add(PosePriorResidual(m.T_world_obj, W),
                            m.robust ? kernel : djpete::solver::RobustKernel::none(), poses.back());
            }
        }
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            problem.add(WhiteNoiseResidual(nodes[k + 1].time_s - nodes[k].time_s, prior.twistWalk),
                        poses[k], twists[k], poses[k + 1], twists[k + 1]);
        }
    }
    djpete::solver::Report solve() {
        djpete::solver::Options o;
        o.maxIterations = 200;
        o.functionTolerance = 1e-14;
        o.stepTolerance = 1e-12;
        return djpete::solver::solve(problem, o);
    }
};

}  // namespace djpete_test
