/// The tracks of one image, found again in the next.
#pragma once

#include <vector>

#include "feature_track.h"
#include "patch_tracker.h"

namespace djpete::frontend {

struct FollowResult {
    std::vector<FeatureTrack> tracks;  ///< those found, with `now.px` in the new image
    geometry::SE3 T_odom_cam;          ///< of the new image, roughly; the start if not measured
    bool usedFullSearch = false;
};

/// Follows `tracks` from `base` to `next`, in two steps. A few spread tracks of known depth are
/// sought widely from where `T_odom_cam_start` would see them; they give the motion to a fraction
/// of a pixel. So each track need be sought near its predicted place only, by its first patch. When
/// the few do not agree, all are sought over the whole pyramid. Tracks on `exclusion`, and the
/// younger of two tracks that meet, end. `seed` is of the samples when a start fails.
FollowResult followTracks(const std::vector<FeatureTrack>& tracks, const GreyPyramid& base,
                          const GreyPyramid& next, const geometry::SE3& T_odom_cam_start,
                          const geometry::StereoCamera& camera, const cv::Mat& exclusion,
                          const FrontendOptions& options, uint64_t seed);

}  // namespace djpete::frontend
