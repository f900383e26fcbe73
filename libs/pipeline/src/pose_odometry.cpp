#include "djpete/pipeline/pose_odometry.h"

#include <string>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"

namespace djpete::pipeline {

PoseOdometry::PoseOdometry(const obs::RigCamera& camera, PoseOdometryOptions options)
    : camera_(camera), options_(options) {}

obs::CObservationVisualKeyframe::Ptr PoseOdometry::process(const obs::SensorFrame& frame) {
    if (!frame.T_world_vehicle_truth) {
        throw obs::InputError("frame " + std::to_string(frame.id.value) +
                              ": no image and no ground-truth pose; expected one of them");
    }
    const geometry::SE3& T_world_vehicle = *frame.T_world_vehicle_truth;
    if (!T_first_vehicle_inverse_) T_first_vehicle_inverse_ = T_world_vehicle.inverse();

    auto out = obs::CObservationVisualKeyframe::Create();
    out->timestamp = frame.stamp;
    out->sensorLabel = obs::label::kKeyframes;
    out->frame = frame.id;
    out->camera = camera_.model;
    out->sensorPose = geometry::toCPose3D(camera_.T_vehicle_cam);
    out->T_odom_cam = *T_first_vehicle_inverse_ * T_world_vehicle * camera_.T_vehicle_cam;
    out->isKeyframe = true;
    if (T_odom_cam_keyframe_) {
        const geometry::SE3 T_kf_cam = T_odom_cam_keyframe_->inverse() * out->T_odom_cam;
        out->isKeyframe = T_kf_cam.translation().norm() >= options_.keyframeTranslation_m ||
                          T_kf_cam.angle_rad() >= options_.keyframeRotation_rad;
    }
    if (out->isKeyframe) T_odom_cam_keyframe_ = out->T_odom_cam;
    return out;
}

}  // namespace djpete::pipeline
