/// The way of one moving object: poses and twists in time, smoothed.
#pragma once

#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/solver/robust_kernel.h"

namespace djpete::backend {

/// White noise on acceleration, in frame obj: what the twist (m/s, rad/s) changes in one second,
/// 1-sigma, and what a twist of a thing on wheels is about.
struct MotionPrior {
    geometry::Vec6 twistWalk = geometry::Vec6::Ones();
    geometry::Vec6 twistSigma = geometry::Vec6::Constant(100);  ///< around zero
};

/// The object at one instant.
struct ChainNode {
    double time_s = 0;
    geometry::SE3 T_world_obj;                      ///< start of the search; the estimate after it
    geometry::Vec6 twist = geometry::Vec6::Zero();  ///< in obj, m/s and rad/s; likewise
    /// What was measured, with information in the frame of the measured object; nothing in gaps.
    struct Measured {
        geometry::SE3 T_world_obj;
        geometry::Mat6 information;
        bool robust = true;  ///< false: believed as it is
    };
    std::vector<Measured> measured;
    geometry::Mat6 covariance = geometry::Mat6::Zero();  ///< of the pose, frame obj; output
    double longitudinalSigma_mps = 0;                    ///< of twist.x(); output
};

struct ChainReport {
    bool usable = false;
    int iterations = 0;
    double initialCost = 0, finalCost = 0;  ///< half of the sum of rho
};

struct ChainOptions {
    solver::RobustKernel kernel = solver::RobustKernel::cauchy(4);
    int maxIterations = 20;
    double relativeTolerance = 1e-4;  ///< fall of the cost at which it is enough
    bool covariances = true;
};

/// Most probable poses and twists of `nodes` (times must rise). A Gaussian process prior on SE(3)
/// with white noise on acceleration joins neighbours (Barfoot, State Estimation for Robotics,
/// section 11.1, with the body-frame twist):
///     e_p = log(exp(-dt w_k) T_k^-1 T_k+1),  e_v = w_k+1 - w_k,
///     Q = diag(twistWalk^2) (x) [dt^3/3 dt^2/2; dt^2/2 dt],
/// and measurements pull with e = log(Z^-1 T). Levenberg-Marquardt on a block tridiagonal system:
/// time grows with the number of nodes. Pure.
ChainReport smooth(std::vector<ChainNode>& nodes, const MotionPrior& prior,
                   const ChainOptions& options);

}  // namespace djpete::backend
