/// From a drive's files to rawlogs.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "djpete/obs/calibration.h"
#include "djpete_app/frame_range.h"
#include "kitti_labels.h"
#include "kitti_layout.h"

namespace djpete::kitti2rawlog {

/// What to convert and how.
struct ConversionJob {
    DriveFiles drive;
    std::filesystem::path out;  ///< the sensor rawlog; companions are named after it
    apps::FrameRange range;
    bool copyFiles = false;  ///< copy images and scans to <out>_Images instead of referring to them
    BoxSigma labelSigma{0.1, 2.0};
    BoxSigma detectionSigma{0.3, 5.0};
};

/// What was written.
struct ConversionReport {
    obs::DriveInfo info;
    uint64_t frames = 0, stereoPairs = 0, singleImages = 0, rightOnly = 0, scans = 0,
             oxtsPackets = 0, truthPoses = 0, labels = 0, detections = 0;
    bool hasLabels = false, hasDetections = false;  ///< there was a source of them
    std::vector<std::filesystem::path> files;       ///< rawlogs, the sensors' first
};

/// Called before each frame with the number of frames done and of all.
using Progress = std::function<void(uint64_t done, uint64_t all)>;

/// Writes the sensor rawlog (head comment with the calibration, then per frame, all with one stamp:
/// images, scan, OXTS, ground truth) and its companions: <out>_objects.rawlog with the detections
/// if there are any, else the labels; <out>_labels.rawlog with the labels if there are both. A
/// companion has the same head and one CObservationDetectedObjects for every frame, empty if
/// nothing was seen. Image boxes are in the left colour image, or in the left grey one if the drive
/// has no colour (KITTI gives them for camera 2; the disparity at the box centre moves them).
/// Ground truth is T_world_vehicle = T_vehicle_cam0 * row * T_cam0_vehicle for a row of the poses
/// file: for KITTI's own files, world is the vehicle at frame 0.
/// Throws InputError naming file and line or frame; what was written until then is kept.
ConversionReport convert(const ConversionJob& job, const Progress& progress);

}  // namespace djpete::kitti2rawlog
