/// How far an estimated camera path is from the truth.
#pragma once

#include <cstddef>
#include <optional>

#include "djpete/evaluation/trajectory.h"

namespace djpete::evaluation {

/// ATE is the distance between positions of the same frame, root of its mean square (RMSE) unless
/// said otherwise.
struct TrajectoryErrors {
    std::size_t frames = 0;
    double ate_se3_m = 0;        ///< after SE(3) alignment
    double ate_unaligned_m = 0;  ///< poses as given
    /// After Sim(3) alignment. A diagnostic of scale only: it hides calibration error. Nothing if a
    /// path does not move.
    std::optional<double> ate_sim3_m, sim3_scale;
    /// Drift by the protocol of the KITTI odometry benchmark: sub-paths of 100, 200 .. 800 m of the
    /// truth, a start every 10 frames; error of the sub-path's end pose seen from its start, per
    /// metre; mean over all sub-paths of all lengths. Nothing if the truth is shorter than 100 m.
    std::optional<double> t_rel_percent, r_rel_deg_per_100m;
    std::size_t segments = 0;  ///< sub-paths behind the drift

    double ate_se3_median_m = 0, ate_se3_max_m = 0;
    /// RMSE of the motion from each frame to the next; nothing for a single frame.
    std::optional<double> rpe_m, rpe_deg;
};

/// Row i of both is the same frame. Throws obs::InputError if the lengths differ or are 0.
TrajectoryErrors evaluateTrajectory(const Trajectory& estimate, const Trajectory& truth);

}  // namespace djpete::evaluation
