/// What stereo and LiDAR say of a track in the current frame.
#pragma once

#include <optional>

#include "feature_track.h"
#include "lidar_depth.h"
#include "stereo_matcher.h"

namespace djpete::frontend {

/// The depth sensors of one frame; either may be missing.
struct DepthSensors {
    geometry::StereoCamera camera;
    std::optional<StereoMatcher> stereo;
    std::optional<ProjectedScan> scan;
};

/// Sets uRight_px, lidarDepth_m and now.inverseDepth (the weighted mean of both) as far as they
/// can be measured. `guess` is 1/z where it is known roughly.
void measureStereo(FeatureTrack& track, const DepthSensors& sensors,
                   std::optional<double> guessInverseDepth);
void measureLidar(FeatureTrack& track, const DepthSensors& sensors);

}  // namespace djpete::frontend
