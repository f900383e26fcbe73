/// KITTI's object labels and detectors' result files as detections.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "djpete/obs/detection.h"
#include "kitti_layout.h"

namespace djpete::kitti2rawlog {

/// How far a source's boxes may be off, independent per axis.
struct BoxSigma {
    double position_m = 0.1;
    double rotation_deg = 2.0;
};

using FramedDetections = std::map<uint64_t, std::vector<obs::ObjectDetection>>;

/// T_cam0_obj of a KITTI box: `bottomCentre_cam` is the centre of its bottom face in the rectified
/// camera 0, `ry_rad` turns about the camera's y axis (down) and is 0 when the object's front looks
/// along the camera's x axis.
geometry::SE3 boxPose(const geometry::Vec3& bottomCentre_cam, double height_m, double ry_rad);

/// Reads one file for a whole drive. Columns, separated by blanks:
///   17 or 18  frame track type truncated occluded alpha left top right bottom h w l x y z ry
///             [score] (label_02, tracking results)
///   15 or 16  the same without frame and track (label_2); the frame is the file's number
/// or separated by commas, as PointRCNN detections are commonly spread:
///   15        frame type left top right bottom score h w l x y z ry alpha, where type is a word or
///             1 Pedestrian, 2 Car, 3 Cyclist
/// DontCare rows are left out. `source` is kept in each detection. Throws InputError naming file
/// and line on any other shape, numbers that are not finite, or sizes that are not positive.
FramedDetections readDetectionFile(const std::filesystem::path& file, const BoxSigma& sigma,
                                   const std::string& source);

/// Reads a folder of per-frame files (label_2/000000.txt, ...).
FramedDetections readDetectionFiles(const FramedFiles& files, const BoxSigma& sigma,
                                    const std::string& source);

}  // namespace djpete::kitti2rawlog
