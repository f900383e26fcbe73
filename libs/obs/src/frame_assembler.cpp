#include "djpete/obs/frame_assembler.h"

#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <cmath>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/labels.h"

namespace djpete::obs {

namespace {

using mrpt::obs::CObservation;

bool isColorLabel(const CObservation& o) {
    return o.sensorLabel == label::kStereoColor || o.sensorLabel == label::kImageColor;
}

bool hasPlace(const CObservation& o) {
    using namespace mrpt::obs;
    return dynamic_cast<const CObservationStereoImages*>(&o) ||
           dynamic_cast<const CObservationImage*>(&o) ||
           dynamic_cast<const CObservationPointCloud*>(&o) ||
           dynamic_cast<const CObservationGPS*>(&o) || dynamic_cast<const CObservationIMU*>(&o) ||
           dynamic_cast<const CObservationRobotPose*>(&o) ||
           dynamic_cast<const CObservationVisualKeyframe*>(&o) ||
           dynamic_cast<const CObservationDetectedObjects*>(&o);
}

/// Puts `o` into its slot of `frame`; a second one of the same slot is left out (first wins).
void place(const CObservation::Ptr& o, SensorFrame& frame) {
    using namespace mrpt::obs;
    if (auto s = std::dynamic_pointer_cast<CObservationStereoImages>(o)) {
        auto& slot = isColorLabel(*o) ? frame.stereoColor : frame.stereoGray;
        if (!slot) slot = s;
    } else if (auto i = std::dynamic_pointer_cast<CObservationImage>(o)) {
        auto& slot = isColorLabel(*o) ? frame.imageColor : frame.imageGray;
        if (!slot) slot = i;
    } else if (auto c = std::dynamic_pointer_cast<CObservationPointCloud>(o)) {
        if (!frame.scan) frame.scan = c;
    } else if (auto g = std::dynamic_pointer_cast<CObservationGPS>(o)) {
        if (!frame.gps) frame.gps = g;
    } else if (auto m = std::dynamic_pointer_cast<CObservationIMU>(o)) {
        if (!frame.imu) frame.imu = m;
    } else if (auto p = std::dynamic_pointer_cast<CObservationRobotPose>(o)) {
        if (!frame.T_world_vehicle_truth) {
            frame.T_world_vehicle_truth = geometry::fromCPose3D(p->pose.mean);
        }
    } else if (auto k = std::dynamic_pointer_cast<CObservationVisualKeyframe>(o)) {
        if (!frame.keyframe) frame.keyframe = k;
    } else if (auto d = std::dynamic_pointer_cast<CObservationDetectedObjects>(o)) {
        frame.detections.push_back(d);
    }
}

}  // namespace

FrameAssembler::FrameAssembler(FrameAssemblerOptions options)
    : options_(std::move(options)), nextId_(options_.firstFrame) {}

std::optional<SensorFrame> FrameAssembler::add(const CObservation::Ptr& observation) {
    std::optional<SensorFrame> finished;
    if (!hasPlace(*observation)) return finished;
    if (current_ && !belongs(*observation)) finished = flush();
    if (!current_) begin(*observation);
    place(observation, *current_);
    return finished;
}

std::optional<SensorFrame> FrameAssembler::flush() {
    if (current_ && current_->keyframe) current_->id = current_->keyframe->frame;
    auto out = std::move(current_);
    current_.reset();
    return out;
}

void FrameAssembler::begin(const CObservation& first) {
    const auto& missing = options_.missing;
    while (std::binary_search(missing.begin(), missing.end(), nextId_)) ++nextId_;
    current_.emplace();
    current_->id = FrameId{nextId_++};
    current_->stamp = first.timestamp;
}

bool FrameAssembler::belongs(const CObservation& o) const {
    const double dt_s = mrpt::system::timeDifference(current_->stamp, o.timestamp);
    return std::abs(dt_s) <= options_.stampSpread_s + 1e-9;
}

}  // namespace djpete::obs
