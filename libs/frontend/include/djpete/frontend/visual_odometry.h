/// Visual odometry: from images (and scans) to poses in `odom` and keyframes with features.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>

#include <memory>
#include <optional>

#include "djpete/frontend/options.h"
#include "djpete/obs/CObservationVisualKeyframe.h"
#include "djpete/obs/ids.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::frontend {

/// What odometry gets of one frame.
struct OdometryInput {
    obs::FrameId frame;
    mrpt::Clock::time_point stamp;
    obs::ImageSet images;
    const obs::LidarScan* scan = nullptr;  ///< may be missing in any frame
    /// 8 bit, size of the left image; not zero: the pixel lies on an object, no feature there.
    std::optional<mrpt::img::CImage> exclusion;
};

/// Wall time of one frame's steps, milliseconds.
struct OdometryTimes {
    double prepare_ms = 0;  ///< grey images and pyramids
    double track_ms = 0;    ///< patch tracking from the frame before
    double pose_ms = 0;     ///< robust pose
    double stereo_ms = 0;   ///< right columns of followed features
    double lidar_ms = 0;    ///< depth from the scan
    double detect_ms = 0;   ///< new corners and their stereo match
    double total_ms = 0;
};

/// What happened in one frame.
struct OdometryStatistics {
    obs::FrameId frame;
    bool tracked = false;  ///< the pose was measured (also true at the first frame)
    bool keyframe = false;
    bool usedFullSearch = false;  ///< prediction failed; tracked over the whole pyramid
    bool usedRansac = false;      ///< pose was restarted from minimal samples
    int followed = 0;             ///< features tracked from the frame before
    int stereoMatched = 0;        ///< current features with a right column
    int withLidarDepth = 0;       ///< current features with LiDAR depth in this frame
    int inliers = 0;              ///< features that agree with the pose
    int added = 0;                ///< new corners
    int features = 0;             ///< current features in all
    double rms_px = 0;  ///< of the left reprojection residuals of inliers with known depth
    OdometryTimes times;
};

/// Follows one drive. `odom` is the vehicle at the first frame: T_odom_cam of that frame is
/// T_vehicle_cam of its images. Same inputs and options give the same bytes, for any number of
/// OpenCV threads.
class VisualOdometry {
  public:
    /// Throws obs::InputError if an option is out of range.
    explicit VisualOdometry(const FrontendOptions& options = {});
    ~VisualOdometry();
    VisualOdometry(VisualOdometry&&) noexcept;
    VisualOdometry& operator=(VisualOdometry&&) noexcept;

    /// Measures the next frame. Keyframes carry all current features (track ids start at 0, grow,
    /// and are never used twice); other frames carry their pose only. If the frame cannot be
    /// measured, its pose is predicted (`tracked` false) and odometry goes on from there.
    ///
    /// Throws obs::InputError, naming the frame: if the first frame has neither a right image nor
    /// a scan; if an image is empty, not 8 bit, or not of the first frame's size; if the
    /// exclusion mask has another size; if stamps do not grow.
    obs::CObservationVisualKeyframe::Ptr process(const OdometryInput& input);

    /// Of the last processed frame.
    const OdometryStatistics& last() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::frontend
