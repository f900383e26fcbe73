/// Odometry of a drive that has poses but no images.
#pragma once

#include <optional>

#include "djpete/obs/sensor_frame.h"

namespace djpete::pipeline {

/// When a frame becomes a keyframe.
struct PoseOdometryOptions {
    double keyframeTranslation_m = 1.5;
    double keyframeRotation_rad = 0.09;
};

/// Turns recorded vehicle poses into odometry observations without features.
class PoseOdometry {
  public:
    /// `camera` is the rig's main camera; detections in images and labels refer to it.
    PoseOdometry(const obs::RigCamera& camera, PoseOdometryOptions options = {});

    /// `odom` is the vehicle at the first call. Throws obs::InputError naming the frame if it has
    /// no pose.
    obs::CObservationVisualKeyframe::Ptr process(const obs::SensorFrame& frame);

  private:
    obs::RigCamera camera_;
    PoseOdometryOptions options_;
    std::optional<geometry::SE3> T_first_vehicle_inverse_;  ///< of the first frame
    std::optional<geometry::SE3> T_odom_cam_keyframe_;
};

}  // namespace djpete::pipeline
