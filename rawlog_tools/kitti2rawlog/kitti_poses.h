/// Poses and times of KITTI.
#pragma once

#include <mrpt/core/Clock.h>

#include <filesystem>
#include <map>
#include <vector>

#include "djpete/geometry/se3.h"
#include "kitti_layout.h"

namespace djpete::kitti2rawlog {

/// Row i is frame i: 12 numbers, T_world_cam0 row by row, world being cam0 at row 0 in KITTI's own
/// files. Rotations are put back on SO(3). Throws InputError naming file and line on a wrong number
/// of columns, numbers that are not finite and matrices that are no rotation.
std::vector<geometry::SE3> readPoses(const std::filesystem::path& file);

/// Stamps by frame, for every frame up to `lastFrame`. A row is seconds (odometry; counted from
/// 2011-09-26 00:00:00 UTC, as MRPT takes a zero stamp for an unset one) or a date with time (raw;
/// taken as UTC). Without a file: 10 Hz, KITTI's nominal rate. Throws InputError naming file and
/// line if the rows end before `lastFrame`, are broken or do not increase.
std::vector<mrpt::Clock::time_point> readTimes(const std::optional<std::filesystem::path>& file,
                                               uint64_t lastFrame);

}  // namespace djpete::kitti2rawlog
