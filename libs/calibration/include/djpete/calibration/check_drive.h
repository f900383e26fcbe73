/// A recorded drive, checked from end to end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>

#include "djpete/calibration/calibration_check.h"
#include "djpete/calibration/corrected_calibration.h"

namespace djpete::calibration {

/// Odometry over frames begin .. end-1 of a rawlog, on images alone, and what they say of the rig;
/// of the frames' images and scans only. With `correction`, of the rig as it puts it right. Throws
/// obs::InputError where the rawlog is damaged, or has no stereo pair in these frames.
CalibrationReport checkDrive(const std::filesystem::path& rawlog,
                             const frontend::FrontendOptions& options, uint64_t begin = 0,
                             uint64_t end = std::numeric_limits<uint64_t>::max(),
                             const CorrectedCalibration* correction = nullptr);

}  // namespace djpete::calibration
