/// How a track is seen from a camera: (u, v, 1/z), its Jacobians and its uncertainty.
#pragma once

#include <optional>

#include "djpete/frontend/options.h"
#include "feature_track.h"

namespace djpete::frontend {

/// Residual z - h of one track. Rows (u, v) in px and, if `rows` is 3, 1/z in 1/m.
struct Linearised {
    int rows = 2;
    geometry::Vec3 residual = geometry::Vec3::Zero();
    geometry::Mat36 dPose = geometry::Mat36::Zero();  ///< dh / d delta, T_odom_cam exp(delta)
    geometry::Vec3 dDepth = geometry::Vec3::Zero();   ///< dh / d anchorDepth.value
    geometry::Vec3 noise = geometry::Vec3::Ones();    ///< variances of z
};

/// Nothing if the point is not in front of the camera.
std::optional<Linearised> linearise(const FeatureTrack& track, const geometry::SE3& T_odom_cam,
                                    const geometry::StereoCamera& camera,
                                    const FrontendOptions& options);

/// Inverse of the residual's covariance: noise plus what the unsure depth adds; for two rows the
/// third row and column are zero.
geometry::Mat3 information(const Linearised& m, double depthVariance);

/// Predicted pixel, or nothing if the point is not in front of the camera.
std::optional<geometry::Vec2> predictPixel(const FeatureTrack& track,
                                           const geometry::SE3& T_odom_cam,
                                           const geometry::StereoCamera& camera);

/// How the residual of a track changes with StereoCalibration::disparity_px at a fixed pose, per
/// px.
geometry::Vec3 residualBias(const FeatureTrack& track, const Linearised& m,
                            const geometry::SE3& T_odom_cam, const geometry::StereoCamera& camera);

/// Kalman update of track.anchorDepth (and of its bias) with the current measurement;
/// `poseCovariance` is that of T_odom_cam's right perturbation, `poseBias` its bias.
void updateDepth(FeatureTrack& track, const geometry::SE3& T_odom_cam,
                 const geometry::Mat6& poseCovariance, const PoseBias& poseBias,
                 const geometry::StereoCamera& camera, const FrontendOptions& options);

}  // namespace djpete::frontend
