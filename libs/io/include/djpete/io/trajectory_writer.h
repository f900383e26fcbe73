/// Trajectories as other tools read them.
#pragma once

#include <string>

#include "djpete/map/slam_map.h"

namespace djpete::io {

/// T_firstcam_cam of every frame of the map from `first` on (the left camera of the keyframes, seen
/// from that of the first of these frames), as `t x y z qx qy qz qw` per line: t in seconds of UNIX
/// time, metres. Throws obs::InputError, naming the file, if it cannot be written; so do all
/// writers here.
void writeTrajectoryTum(const map::SlamMap& map, const std::string& file, map::FrameId first = {});

/// The same poses as rows of 3x4 matrices, row-major, one line per frame (KITTI's format). The
/// file has no frame numbers: lines are the map's frames in order.
void writeTrajectoryKitti(const map::SlamMap& map, const std::string& file,
                          map::FrameId first = {});

}  // namespace djpete::io
