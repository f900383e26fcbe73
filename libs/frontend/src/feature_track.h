/// One corner followed through the images, and what is known of its depth.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/ids.h"
#include "stereo_calibration.h"

namespace djpete::frontend {

/// An inverse depth 1/z in 1/m with its variance.
struct InverseDepth {
    double value = 0;
    double variance = 1;
};

/// What one frame measures of a track: its pixel, and 1/z in cam by stereo or LiDAR.
struct TrackMeasurement {
    cv::Point2f px;
    std::optional<InverseDepth> inverseDepth;
    double stereoShare = 0;  ///< of inverseDepth, beside LiDAR
};

/// How a pose (its right perturbation) changes with StereoCalibration::disparity_px, per px.
using PoseBias = geometry::Vec6;

/// The point lies on the ray of its first pixel: p_anchor = ray_anchor / anchorDepth.value.
struct FeatureTrack {
    obs::TrackId id;
    geometry::SE3 T_odom_anchor;         ///< camera of its first frame
    geometry::Vec3 ray_anchor{0, 0, 1};  ///< z = 1
    InverseDepth anchorDepth;            ///< in the anchor camera, filtered
    double inverseDepthPerRow = 0;       ///< in the anchor's image, 1/m per px: the surface's slope
    double depthBias = 0;                ///< change of anchorDepth likewise, 1/m per px
    PoseBias anchorPoseBias = PoseBias::Zero();  ///< of T_odom_anchor
    cv::Mat anchorPatch;                         ///< the first image about the corner
    int framesFollowed = 0;
    TrackMeasurement now;            ///< in the current frame
    std::optional<float> uRight_px;  ///< current frame
    float disparitySigma_px = 0;
    float rowDifference_px = 0;         ///< row in the right image less that in the left
    std::optional<float> lidarDepth_m;  ///< current frame
    float lidarSigma_m = 0;
    std::array<uint8_t, 3> rgb{128, 128, 128};

    /// q = R ray + value t, the point seen from the camera times its anchor's inverse depth: finite
    /// for points at infinity.
    geometry::Vec3 scaledPoint(const geometry::SE3& T_cam_anchor) const {
        return T_cam_anchor.rotation() * ray_anchor +
               anchorDepth.value * T_cam_anchor.translation();
    }
    /// Moves on to the next frame, where the corner is at `px`; nothing else is measured there yet.
    void startFrame(const cv::Point2f& px) {
        now = TrackMeasurement{px, std::nullopt, 0};
        uRight_px.reset();
        lidarDepth_m.reset();
        ++framesFollowed;
    }
    /// Standard deviation of the depth is below a third of it.
    bool depthKnown() const {
        return anchorDepth.variance < anchorDepth.value * anchorDepth.value / 9.0;
    }
};

}  // namespace djpete::frontend
