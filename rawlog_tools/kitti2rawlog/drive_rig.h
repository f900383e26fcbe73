/// Which frames and cameras a conversion has to do with.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "conversion.h"
#include "kitti_calibration.h"

namespace djpete::kitti2rawlog {

/// The calibration that applies to the frames of `range`. Throws InputError like the readers, and
/// in the object layout if the frames' calibrations differ.
KittiCalibration readCalibration(const DriveFiles& drive, const std::vector<uint64_t>& frames);

/// One left camera with its right one.
struct CameraPair {
    std::size_t left = 0, right = 1;
    bool hasLeft = false, hasRight = false;  ///< images of it are among the frames
    ImageSize size;                          ///< of all its images
    std::optional<obs::RigCamera> stereo;    ///< if there are right images, or no images at all
    std::optional<obs::RigCamera> mono;
    const std::optional<obs::RigCamera>& rig() const { return stereo ? stereo : mono; }
};

/// Cameras `left`, `left + 1` as far as `frames` have their images, sized after the first one (all
/// others are checked when written). A drive with no images at all has the calibrated pair, with
/// the calibrated size or KITTI's nominal 1242x375.
CameraPair findPair(const DriveFiles& drive, const KittiCalibration& calibration,
                    const std::vector<uint64_t>& frames, std::size_t left);

/// The head of the rawlog.
obs::DriveInfo driveInfo(const DriveFiles& drive, const std::vector<uint64_t>& frames,
                         const CameraPair& gray, const CameraPair& color);

}  // namespace djpete::kitti2rawlog
