/// Reads trajectories from text.
#pragma once

#include <string>
#include <vector>

#include "djpete/evaluation/trajectory.h"

namespace djpete::evaluation {

/// A trajectory and where it came from.
struct TrajectoryFile {
    std::string path;
    Trajectory poses;
    std::vector<double> stamps_s;  ///< one per pose, or none at all (KITTI files have no times)
};

/// Reads either of two layouts; the first row decides and all rows must agree:
/// - KITTI odometry: 12 numbers a row, the 3x4 matrix [R t] row by row;
/// - TUM: `t x y z qx qy qz qw`, t in seconds and rising.
/// Numbers are separated by blanks; lines that start with '#' are comments. R is put back on SO(3)
/// (files hold few digits).
/// Throws obs::InputError naming file and line if the file is missing or has no pose, a row has
/// another number of columns, a number is not finite, R^T R differs from identity by more than 1e-3
/// or is a reflection, a quaternion's length differs from 1 by more than 1e-3, or t does not rise.
TrajectoryFile readTrajectory(const std::string& path);

}  // namespace djpete::evaluation
