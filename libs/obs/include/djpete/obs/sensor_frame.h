/// What all sensors saw at one stamp.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <optional>
#include <string>
#include <vector>

#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/CObservationVisualKeyframe.h"
#include "djpete/obs/calibration.h"
#include "djpete/obs/ids.h"

namespace djpete::obs {

/// One LiDAR return in `velo`, metres; intensity in 0..1.
struct ScanPoint {
    float x = 0, y = 0, z = 0, intensity = 0;
    geometry::Vec3 position() const { return {x, y, z}; }
};

struct LidarScan {
    std::vector<ScanPoint> points;
    geometry::SE3 T_vehicle_velo;
};

/// Images of one rectified camera or pair, in memory.
struct ImageSet {
    mrpt::img::CImage left;                  ///< grey or BGR, 8 bit
    std::optional<mrpt::img::CImage> right;  ///< same size as left
    RigCamera camera;                        ///< baseline_m > 0 exactly if there is a right image
    bool isColor() const { return left.isColor(); }
};

/// The observations of one frame; images and scans stay on disk until loaded. Copying is cheap
/// (shared pointers). The load functions throw InputError naming the file and what was expected.
/// They are not safe to call from two threads on the same frame.
struct SensorFrame {
    FrameId id;
    mrpt::Clock::time_point stamp;
    mrpt::obs::CObservationStereoImages::Ptr stereoGray, stereoColor;
    mrpt::obs::CObservationImage::Ptr imageGray, imageColor;  ///< when there is no right image
    mrpt::obs::CObservationPointCloud::Ptr scan;
    mrpt::obs::CObservationGPS::Ptr gps;
    mrpt::obs::CObservationIMU::Ptr imu;
    std::optional<geometry::SE3> T_world_vehicle_truth;
    CObservationVisualKeyframe::Ptr keyframe;  ///< recorded front end output, if any
    std::vector<CObservationDetectedObjects::Ptr> detections;

    bool hasImages() const { return stereoGray || stereoColor || imageGray || imageColor; }
    bool hasScan() const { return static_cast<bool>(scan); }

    /// Images for odometry: grey if there are any, else colour; nothing if the frame has no image.
    std::optional<ImageSet> loadMainImages() const;
    /// Images for texture: colour if there are any, else grey.
    std::optional<ImageSet> loadTextureImages() const;
    /// The scan without its no-return points (all of x, y, z zero); nothing if the frame has none.
    /// Throws also on points that are not finite.
    std::optional<LidarScan> loadScan() const;
    /// Lets images and scan go from memory (they load again when asked for).
    void unload() const;
};

}  // namespace djpete::obs
