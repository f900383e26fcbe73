/// Detections made earlier: by a network on another machine, by hand, by detect-objects.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>

#include "djpete/observers/object_observer.h"

namespace djpete::observers {

/// Replays detections by time stamp; needs neither scan nor image.
class RecordedObserver : public ObjectObserver {
  public:
    /// Only what lies in the frames themselves (a rawlog that also holds detections).
    RecordedObserver() = default;
    /// Reads the companion rawlog whole. Throws obs::InputError if it cannot be read.
    explicit RecordedObserver(const std::filesystem::path& objectsRawlog);

    std::string name() const override { return "recorded"; }
    /// The entry of the file whose stamp is nearest to the frame's and at most 1 ms away; several
    /// entries of one stamp are joined if they share their sensor pose, else obs::InputError.
    /// Without a file: the frame's own detections, joined alike. nullptr if there are none for this
    /// frame.
    obs::CObservationDetectedObjects::Ptr observe(const obs::SensorFrame& frame,
                                                  const obs::LidarScan* scan,
                                                  const obs::RigCamera* camera) override;
    /// Number of stamps that the file holds.
    std::size_t size() const { return byStamp_.size(); }

  private:
    bool hasFile_ = false;
    std::string origin_ = "the frame";
    std::map<mrpt::Clock::time_point, obs::CObservationDetectedObjects::Ptr> byStamp_;
};

}  // namespace djpete::observers
