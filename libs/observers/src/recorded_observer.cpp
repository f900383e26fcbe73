#include "djpete/observers/recorded_observer.h"

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "djpete/obs/rawlog_source.h"

namespace djpete::observers {

namespace {

using obs::CObservationDetectedObjects;

constexpr std::chrono::microseconds kStampTolerance{1000};

bool sameSensor(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b) {
    return (geometry::fromCPose3D(a).inverse() * geometry::fromCPose3D(b)).log().norm() < 1e-9;
}

CObservationDetectedObjects::Ptr copyOf(const CObservationDetectedObjects& o) {
    auto out = CObservationDetectedObjects::Create();
    out->timestamp = o.timestamp;
    out->sensorLabel = obs::label::kDetections;
    out->sensorPose = o.sensorPose;
    out->detections = o.detections;
    return out;
}

/// Adds the detections of `more` to `sum`; both speak in the frame of the same sensor.
void join(CObservationDetectedObjects& sum, const CObservationDetectedObjects& more,
          const std::string& origin) {
    if (!sameSensor(sum.sensorPose, more.sensorPose)) {
        throw obs::InputError(origin + ": two sets of detections with stamp " +
                              mrpt::system::dateTimeToString(sum.timestamp) +
                              " come from different sensor poses; expected one sensor per stamp");
    }
    sum.detections.insert(sum.detections.end(), more.detections.begin(), more.detections.end());
}

}  // namespace

RecordedObserver::RecordedObserver(const std::filesystem::path& objectsRawlog)
    : hasFile_(true), origin_(objectsRawlog.string()) {
    for (const auto& entry : obs::readDetections(objectsRawlog)) {
        auto& slot = byStamp_[entry->timestamp];
        if (slot) {
            join(*slot, *entry, origin_);
        } else {
            slot = copyOf(*entry);
        }
    }
}

CObservationDetectedObjects::Ptr RecordedObserver::observe(const obs::SensorFrame& frame,
                                                           const obs::LidarScan* /*scan*/,
                                                           const obs::RigCamera* /*camera*/) {
    CObservationDetectedObjects::Ptr out;
    if (!hasFile_) {
        for (const auto& entry : frame.detections) {
            if (out) {
                join(*out, *entry, "frame " + std::to_string(frame.id.value));
            } else {
                out = copyOf(*entry);
            }
        }
    } else {
        auto best = kStampTolerance;
        using std::chrono::duration_cast;
        for (auto it = byStamp_.lower_bound(frame.stamp - kStampTolerance);
             it != byStamp_.end() && it->first <= frame.stamp + kStampTolerance; ++it) {
            const auto gap = duration_cast<std::chrono::microseconds>(
                it->first < frame.stamp ? frame.stamp - it->first : it->first - frame.stamp);
            if (out && gap >= best) continue;
            best = gap;
            out = it->second;
        }
        if (out) out = copyOf(*out);
    }
    if (out) out->timestamp = frame.stamp;
    return out;
}

}  // namespace djpete::observers
