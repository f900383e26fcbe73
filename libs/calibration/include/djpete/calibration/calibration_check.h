/// What a drive says of its rig, without any ground truth.
#pragma once

#include <memory>
#include <string>

#include "djpete/frontend/visual_odometry.h"
#include "djpete/obs/CObservationVisualKeyframe.h"

namespace djpete::calibration {

/// One measured number.
struct Estimate {
    double value = 0;
    double sigma = 0;    ///< standard error, from how frames agree with each other
    bool known = false;  ///< false: the drive does not tell
    /// Differs from `nominal` by more than three standard errors and by more than `matters`.
    bool deviates(double nominal, double matters) const;
};

/// Row in the right image minus row in the left one, of the same point, as a plane over the image:
/// offset + perColumn * (u - cx) / fx + perRow * (v - cy) / fy, all in pixels; u is the column in
/// the right image, v the row in the left one.
struct RowCheck {
    Estimate offset_px;
    /// Right camera rolled: pixels per unit of (u - cx) / fx; divided by fx, an angle in rad.
    Estimate perColumn_px;
    /// Right camera with another focal length: pixels per unit of (v - cy) / fy.
    Estimate perRow_px;
    double rms_px = 0;  ///< of single measurements about the plane
    std::size_t measurements = 0, frames = 0;
    std::string verdict;
};

/// Disparities against the scans: d_measured = scale * fx * baseline / z_lidar + offset.
struct DisparityCheck {
    Estimate offset_px, scale;
    double rms_px = 0;  ///< of single disparities
    std::size_t measurements = 0, frames = 0;
    std::string verdict;
};

/// The turn and shift that bring the stated camera to where scan and stereo agree:
/// T_vehicle_cam_true = T_vehicle_cam * exp(shift, tilt), in axes of cam (x right, y down, z
/// forward).
struct LidarCameraCheck {
    Estimate tiltX_rad, tiltY_rad, tiltZ_rad;  ///< about x: pitch; y: yaw; z: roll
    Estimate shiftX_m, shiftY_m, shiftZ_m;
    std::size_t measurements = 0, frames = 0;
    std::string verdict;
};

struct CalibrationReport {
    RowCheck rows;
    DisparityCheck disparity;
    LidarCameraCheck lidar;
};

/// Text for people: one block per check.
std::string toText(const CalibrationReport& report);

/// Collects measurements from the keyframes of a drive. Rows: corners of the left image found again
/// in the right one, in both directions. Disparity, tilt and shift: those corners against planes
/// through the scan's points about them, all eight numbers in one robust adjustment, so that a tilt
/// does not pass for a scale. Equal inputs give equal reports.
class CalibrationCheck {
  public:
    CalibrationCheck();
    ~CalibrationCheck();
    CalibrationCheck(CalibrationCheck&&) noexcept;
    CalibrationCheck& operator=(CalibrationCheck&&) noexcept;

    /// One frame with what odometry made of it. Frames that are no keyframes, or without a right
    /// image, say nothing. Throws obs::InputError if an image is not 8 bit or sizes differ.
    void add(const frontend::OdometryInput& input, const obs::CObservationVisualKeyframe& odometry);
    /// Of all frames so far.
    CalibrationReport report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::calibration
