/// A camera path as evaluation sees it.
#pragma once

#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete::evaluation {

/// One pose T_world_cam per frame, in frame order. World is whatever the file's author chose
/// (KITTI: the camera at frame 0); cam is the left rectified optical frame.
using Trajectory = std::vector<geometry::SE3>;

/// The same path seen from its own first pose: row i becomes path[0]^-1 path[i].
Trajectory startingAtIdentity(const Trajectory& path);

}  // namespace djpete::evaluation
