/// The tracks of one image, found again in the next.
#pragma once

#include <vector>

#include "feature_track.h"
#include "patch_tracker.h"

namespace djpete::frontend {

struct FollowResult {
    std::vector<FeatureTrack> tracks;  ///< those found, with `now.px` in the new image
    bool usedFullSearch = false;
};

/// Follows `tracks` from `base` to `next`. With `T_odom_cam_predicted` each patch starts where its
/// point would be seen; without, or when too few are found so, it starts where it was and is
/// searched over the whole pyramid. Tracks on `exclusion`, and the younger of two tracks that meet,
/// end.
FollowResult followTracks(const std::vector<FeatureTrack>& tracks, const GreyPyramid& base,
                          const GreyPyramid& next,
                          const std::optional<geometry::SE3>& T_odom_cam_predicted,
                          const geometry::StereoCamera& camera, const cv::Mat& exclusion,
                          const FrontendOptions& options);

}  // namespace djpete::frontend
