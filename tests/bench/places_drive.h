/// The keyframes that the front end makes of a drive, with true poses.
#pragma once

#include <filesystem>
#include <vector>

#include "djpete/map/entities.h"

namespace djpete_bench {

struct PlacesDrive {
    std::vector<djpete::map::Keyframe> keyframes;   ///< ids 0, 1, ...; no landmarks
    std::vector<djpete::geometry::SE3> T_true_cam;  ///< of each keyframe; any one true world
    double frontend_ms = 0;                         ///< mean of all frames
};

/// Runs the front end on a rawlog or on a folder in the layout of KITTI odometry. Row n of `truth`
/// is the camera at frame n (KITTI's pose file). Keyframes are read from `cache` if that file
/// exists, or else written to it; an empty path means no cache.
/// Throws std::runtime_error or obs::InputError with one sentence.
PlacesDrive openPlacesDrive(const std::filesystem::path& drive, const std::filesystem::path& truth,
                            const std::filesystem::path& cache);

}  // namespace djpete_bench
