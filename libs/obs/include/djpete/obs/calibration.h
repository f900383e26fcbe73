/// The rig of a drive; travels as INI text in the rawlog's leading comment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"

namespace djpete::obs {

/// A camera (or rectified stereo pair) on the vehicle.
struct RigCamera {
    geometry::StereoCamera model;  ///< baseline_m == 0: only the left camera exists
    geometry::SE3 T_vehicle_cam;   ///< left optical frame on the vehicle
};

/// What the head of a rawlog says of its drive.
struct DriveInfo {
    std::string name;                ///< e.g. "kitti odometry 00"
    uint64_t firstFrame = 0;         ///< FrameId of the first frame in the file
    uint64_t frameCount = 0;         ///< 0: unknown
    std::vector<uint64_t> missing;   ///< frames in range with no observation at all
    std::optional<RigCamera> gray;   ///< KITTI cameras 0, 1
    std::optional<RigCamera> color;  ///< KITTI cameras 2, 3
    geometry::SE3 T_vehicle_velo;    ///< identity for KITTI

    /// The camera that odometry uses: grey if there is one, else colour. Throws InputError naming
    /// `origin` if there is none.
    const RigCamera& mainCamera(const std::string& origin) const;
};

/// INI text: [DRIVE], and per camera MRPT's TStereoCamera sections ([GRAY_LEFT], [GRAY_RIGHT],
/// [GRAY_LEFT2RIGHT_POSE]; COLOR likewise) plus [GRAY_ON_VEHICLE] with the left camera's pose.
std::string toIniText(const DriveInfo& info);
/// Inverse of toIniText. Throws InputError naming `origin` on a missing or broken entry.
DriveInfo driveInfoFromIniText(const std::string& text, const std::string& origin);

}  // namespace djpete::obs
