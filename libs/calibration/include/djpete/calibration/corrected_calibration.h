/// A rig put right by what a drive said of it.
#pragma once

#include <mrpt/img/CImage.h>

#include "djpete/calibration/calibration_check.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::calibration {

/// What is known to deviate, and by more than it matters; all else stays as stated.
struct CorrectedCalibration {
    obs::RigCamera camera;  ///< baseline and pose corrected
    /// Pixels to add: the right image at (u, v) is the stated one's at
    /// (u - columnOffset_px, v + offset + slopes), see RowCheck.
    double columnOffset_px = 0;
    double rowOffset_px = 0, rowPerColumn_px = 0, rowPerRow_px = 0;

    bool warpsRight() const {
        return columnOffset_px != 0 || rowOffset_px != 0 || rowPerColumn_px != 0 ||
               rowPerRow_px != 0;
    }
    /// The images with the corrected camera and, where that is needed, a right image whose rows and
    /// columns are those that the camera's model expects.
    obs::ImageSet apply(const obs::ImageSet& images) const;
};

/// Only numbers that deviate by more than three standard errors are corrected.
CorrectedCalibration corrected(const obs::RigCamera& calibration, const CalibrationReport& report);

}  // namespace djpete::calibration
