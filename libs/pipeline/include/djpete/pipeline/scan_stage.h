/// Scan matching beside the front end.
#pragma once

#include <mrpt/core/Clock.h>

#include <functional>
#include <optional>

#include "djpete/obs/CObservationVisualKeyframe.h"
#include "djpete/obs/sensor_frame.h"
#include "djpete/pipeline/stage_times.h"
#include "djpete/scans/scan_matcher.h"

namespace djpete::pipeline {

/// Adds to each keyframe that has a scan how the camera moved since the last such keyframe.
class ScanStage {
  public:
    using FrontEnd = std::function<obs::CObservationVisualKeyframe::Ptr()>;

    /// `threaded`: scans are thinned out on another thread while the front end works; same results.
    ScanStage(const scans::ScanOptions& options, bool threaded)
        : options_(options), threaded_(threaded), matcher_(options) {}

    /// What `frontEnd` returns, with the scan's motion. `scan` is null if the frame has none.
    obs::CObservationVisualKeyframe::Ptr process(const obs::LidarScan* scan,
                                                 const FrontEnd& frontEnd, StageTable& times);

  private:
    void match(const scans::PreparedScan& scan, obs::CObservationVisualKeyframe& keyframe);
    geometry::Vec6 twistPerSecond(const geometry::SE3& T_odom_vehicle,
                                  mrpt::Clock::time_point stamp) const;

    scans::ScanOptions options_;
    bool threaded_;
    scans::ScanMatcher matcher_;
    std::optional<geometry::SE3> T_odom_vehicle_before_;  ///< of the frame before
    mrpt::Clock::time_point stampBefore_;
};

}  // namespace djpete::pipeline
