/// Right columns of left corners in a rectified pair.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "djpete/frontend/options.h"
#include "djpete/geometry/camera.h"
#include "stereo_calibration.h"

namespace djpete::frontend {

struct StereoMatch {
    float uRight_px = 0;
    float disparitySigma_px = 0;
    float disparityPerRow = 0;   ///< how the disparity grows down the rows
    float rowDifference_px = 0;  ///< row in the right image less that in the left
};

/// Matches along the row. Search by zero-mean absolute differences over all disparities that
/// depths from options.stereoMinDepth_m to infinity allow, then inverse-compositional refinement
/// for shift and shear (the disparity of a sloping surface changes from row to row; without the
/// shear the road would not correlate). Rows and disparities are corrected by the calibration.
class StereoMatcher {
  public:
    /// Both images 8 bit grey, of one size; they are not copied.
    StereoMatcher(const cv::Mat& left, const cv::Mat& right, const geometry::StereoCamera& camera,
                  const StereoCalibration& calibration, const FrontendOptions& options);

    /// The match of the left pixel, or nothing if there is none, several, or it does not match
    /// back. With `guess_px` (a disparity) only its neighbourhood is tried, and a match that the
    /// guess foretold need not match back.
    std::optional<StereoMatch> match(const cv::Point2f& left_px,
                                     std::optional<double> guess_px) const;

  private:
    struct SearchResult {
        int disparity_px = 0;
        double ambiguity = 0;  ///< the best cost by the best elsewhere
    };
    /// `rowTo` is the row in `to`; the others are of `from`.
    std::optional<SearchResult> search(const cv::Mat& from, const cv::Mat& to, int x, int row,
                                       int rowTo, int sign) const;
    std::optional<StereoMatch> refined(const cv::Point2f& left_px, double disparity_px,
                                       double maxShift_px) const;
    bool matchesBack(const cv::Point2f& left_px, const StereoMatch& match) const;

    geometry::Vec3 rayOf(const cv::Point2f& left_px) const {
        return camera_.ray({left_px.x, left_px.y});
    }
    std::optional<StereoMatch> rawMatch(const cv::Point2f& left_px,
                                        std::optional<double> guess_px) const;

    cv::Mat left_, right_;
    geometry::StereoCamera camera_;
    StereoCalibration calibration_;
    FrontendOptions options_;
    int maxDisparity_px_;
};

}  // namespace djpete::frontend
