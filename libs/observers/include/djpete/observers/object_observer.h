/// Whoever says which objects a frame shows.
#pragma once

#include <string>

#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/calibration.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::observers {

/// One detector. Not thread-safe: use one observer per thread. The same calls give the same result.
class ObjectObserver {
  public:
    virtual ~ObjectObserver() = default;

    /// Short name; also the `source` of its detections where it makes them itself.
    virtual std::string name() const = 0;

    /// The detections of `frame` (stamp = the frame's, sensorLabel = obs::label::kDetections, and
    /// possibly none in it), or nullptr if the observer can say nothing about this frame (e.g. it
    /// needs a scan and there is none). `scan` is the frame's scan if it has one, `camera` the left
    /// camera that image boxes and masks are made for; either may be null. Throws obs::InputError
    /// on input it cannot use.
    virtual obs::CObservationDetectedObjects::Ptr observe(const obs::SensorFrame& frame,
                                                          const obs::LidarScan* scan,
                                                          const obs::RigCamera* camera) = 0;
};

}  // namespace djpete::observers
