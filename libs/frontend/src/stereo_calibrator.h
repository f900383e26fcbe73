/// Estimates what the rectification left of errors, while driving.
#pragma once

#include <vector>

#include "djpete/frontend/options.h"
#include "feature_track.h"

namespace djpete::frontend {

/// The rows of stereo matches show the field of rows at once. A common error of disparities shows
/// in motion only: a point's disparities before and after do not fit the motion that fits near and
/// far points alike. Poses and depths were estimated with that error in them; how they depend on it
/// is carried along (Friedland, Treatment of bias in recursive filtering, 1969), so that it can be
/// told from motion, and taken back out of the tracks when it is known better.
class StereoCalibrator {
  public:
    explicit StereoCalibrator(const FrontendOptions& options);

    const StereoCalibration& calibration() const { return calibration_; }

    /// Learns from the rows of the current stereo matches.
    void learnRows(const std::vector<FeatureTrack>& tracks, const geometry::StereoCamera& camera);

    /// Learns from inliers of the measured pose, whose depths have not seen the current measurement
    /// yet, and corrects them: depth, place of the anchor beside the camera, current disparity.
    void learnDisparity(std::vector<FeatureTrack>& inliers, const geometry::SE3& T_odom_cam,
                        const geometry::StereoCamera& camera, const FrontendOptions& options);

    /// How the current camera's pose depends on the disparity's error.
    const PoseBias& poseBias() const { return poseBias_; }

  private:
    void correct(std::vector<FeatureTrack>& tracks, double change_px,
                 const geometry::SE3& T_odom_cam, const geometry::StereoCamera& camera) const;

    bool enabled_;
    StereoCalibration calibration_;
    Eigen::Matrix<double, 6, 6> rowInformation_;
    RowTerms rowSum_ = RowTerms::Zero();
    double disparityInformation_;  ///< 1/px^2
    PoseBias poseBias_ = PoseBias::Zero();
};

}  // namespace djpete::frontend
