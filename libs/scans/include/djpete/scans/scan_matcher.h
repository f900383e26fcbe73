/// From keyframes' scans to the motions between them.
#pragma once

#include <memory>
#include <optional>

#include "djpete/geometry/se3.h"
#include "djpete/obs/ids.h"
#include "djpete/scans/options.h"
#include "djpete/scans/prepared_scan.h"

namespace djpete::scans {

/// The vehicle's motion since the keyframe before.
struct ScanMatch {
    obs::FrameId from;  ///< frame of that keyframe
    geometry::SE3 T_from_vehicle;
    /// Of T_from_vehicle, in the frame of the vehicle now. Directions that the scans do not tell
    /// (along a corridor) have next to none.
    geometry::Mat6 information;
    std::size_t matched = 0;  ///< points on planes
    double rms_m = 0;         ///< their distance to them
};

/// Aligns each keyframe's scan with a local map of the scans before (point to plane). Holds its own
/// path, which starts at the first scan and drifts. Same calls, same bytes.
class ScanMatcher {
  public:
    explicit ScanMatcher(const ScanOptions& options);
    ~ScanMatcher();
    ScanMatcher(ScanMatcher&&) noexcept;
    ScanMatcher& operator=(ScanMatcher&&) noexcept;

    /// The next keyframe that has a scan, with its pose as odometry gave it and its motion (twist
    /// per second in its own frame, for scanners that turn while driving). Nothing if it is the
    /// first, or does not fit the local map, which then begins anew with it.
    std::optional<ScanMatch> addKeyframe(obs::FrameId frame, const PreparedScan& scan,
                                         const geometry::SE3& T_odom_vehicle,
                                         const geometry::Vec6& twistPerSecond);
    /// Forgets everything, as after a break of odometry.
    void reset();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::scans
