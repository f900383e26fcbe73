#include "djpete/pipeline/scan_stage.h"

#include <chrono>
#include <future>

#include "djpete/geometry/mrpt_bridge.h"

namespace djpete::pipeline {

using geometry::SE3;

obs::CObservationVisualKeyframe::Ptr ScanStage::process(const obs::LidarScan* scan,
                                                        const FrontEnd& frontEnd,
                                                        StageTable& times) {
    if (!options_.enabled) return frontEnd();
    // A future of std::async waits when it goes, also if the front end throws.
    std::future<scans::PreparedScan> prepared;
    if (scan) {
        prepared = std::async(threaded_ ? std::launch::async : std::launch::deferred,
                              [this, scan] { return scans::prepareScan(*scan, options_); });
    }
    auto out = frontEnd();
    if (out->isKeyframe && !out->tracked) matcher_.reset();
    if (out->isKeyframe && scan) {
        measured(times, "scans", [&] { match(prepared.get(), *out); });
    }
    T_odom_vehicle_before_ = out->T_odom_cam * geometry::fromCPose3D(out->sensorPose).inverse();
    stampBefore_ = out->timestamp;
    return out;
}

void ScanStage::match(const scans::PreparedScan& scan, obs::CObservationVisualKeyframe& keyframe) {
    const SE3 T_vehicle_cam = geometry::fromCPose3D(keyframe.sensorPose);
    const SE3 T_odom_vehicle = keyframe.T_odom_cam * T_vehicle_cam.inverse();
    const auto motion = matcher_.addKeyframe(keyframe.frame, scan, T_odom_vehicle,
                                             twistPerSecond(T_odom_vehicle, keyframe.timestamp));
    if (!motion) return;
    // exp(x) of the vehicle is exp(Ad(T_vehicle_cam)^-1 x) of the camera.
    const geometry::Mat6 Ad = T_vehicle_cam.adjoint();
    const geometry::Mat6 information = Ad.transpose() * motion->information * Ad;
    keyframe.scanMotion = obs::ScanMotion{
        motion->from,
        (T_vehicle_cam.inverse() * motion->T_from_vehicle * T_vehicle_cam).normalised(),
        0.5 * (information + information.transpose())};
}

geometry::Vec6 ScanStage::twistPerSecond(const SE3& T_odom_vehicle,
                                         mrpt::Clock::time_point stamp) const {
    const double dt_s =
        T_odom_vehicle_before_ ? std::chrono::duration<double>(stamp - stampBefore_).count() : 0.0;
    if (!(dt_s > 0)) return geometry::Vec6::Zero();
    return (T_odom_vehicle_before_->inverse() * T_odom_vehicle).log() / dt_s;
}

}  // namespace djpete::pipeline
