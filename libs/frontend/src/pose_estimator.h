/// Robust camera pose from followed features.
#pragma once

#include <cstdint>
#include <vector>

#include "djpete/frontend/options.h"
#include "feature_track.h"

namespace djpete::frontend {

struct PoseEstimate {
    geometry::SE3 T_odom_cam;
    geometry::Mat6 covariance = geometry::Mat6::Identity();  ///< of the right perturbation
    std::vector<bool> inlier;                                ///< per track
    int inlierCount = 0;
    double rms_px = 0;  ///< of the (u, v) residuals of inliers with known depth
};

/// Minimises the Geman-McClure cost of all tracks' residuals by Gauss-Newton from `T_odom_cam`,
/// the kernel narrowed step by step. Each residual is weighted with its pixel noise and with its
/// track's depth uncertainty, so far and fresh points count for what they tell.
PoseEstimate estimatePose(const std::vector<FeatureTrack>& tracks, const geometry::SE3& T_odom_cam,
                          const geometry::StereoCamera& camera, const FrontendOptions& options);

/// The same from minimal samples (three points with known depth), for when no start is known. The
/// best sample is refined as above. `seed` fixes the samples.
PoseEstimate estimatePoseFromSamples(const std::vector<FeatureTrack>& tracks,
                                     const geometry::SE3& fallback_T_odom_cam,
                                     const geometry::StereoCamera& camera,
                                     const FrontendOptions& options, uint64_t seed);

}  // namespace djpete::frontend
