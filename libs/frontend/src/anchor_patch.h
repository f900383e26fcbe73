/// The first patch of a track, found again in later images.
#pragma once

#include "djpete/frontend/options.h"
#include "feature_track.h"

namespace djpete::frontend {

/// The image about a corner, large enough to warp the patch from; a copy.
cv::Mat anchorPatchAt(const cv::Mat& grey, const cv::Point2f& px);

enum class AnchorOutcome {
    kFound,
    kLost,     ///< the patch is not there, or looks different
    kNoPatch,  ///< the surface is seen too differently from there, or the depth is not known
};

struct AnchorPlace {
    AnchorOutcome outcome = AnchorOutcome::kNoPatch;
    std::optional<cv::Point2f> px;  ///< if found
};

/// Where the first patch of a track, warped as motion and depth say, matches best, from where
/// T_cam_odom predicts it: so the place does not slide away frame by frame.
AnchorPlace findFirstPatch(const FeatureTrack& track, const cv::Mat& grey,
                           const geometry::SE3& T_cam_odom, const geometry::StereoCamera& camera,
                           const FrontendOptions& options);

}  // namespace djpete::frontend
