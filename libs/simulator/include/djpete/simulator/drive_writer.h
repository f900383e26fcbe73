/// A simulated drive in KITTI's folder layout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "djpete/simulator/labels.h"
#include "djpete/simulator/renderer.h"

namespace djpete::simulator {

struct DriveOptions {
    WorldOptions world;
    uint64_t begin = 0, end = 100;  ///< frames begin .. end-1 are written
    int width_px = 1241, height_px = 376;
    bool scans = true;   ///< velodyne
    bool colour = true;  ///< image_2 and image_3
    LidarOptions lidar;
    LabelOptions labels;
    DetectorNoise detector;
    unsigned threads = 2;
};

/// Called after each frame with how many are done and how many there are.
using Progress = std::function<void(uint64_t done, uint64_t all)>;

/// Writes image_0 .. image_3, velodyne, instances, calib.txt, times.txt, poses.txt (camera 0 seen
/// from camera 0 of frame 0), label_02.txt and detections.txt (the labels as a noisy detector would
/// give them). Files carry the number of their frame; rows of times.txt and poses.txt start at
/// frame 0. Instances are 16-bit PNG in KITTI's MOTS coding: 1000 * class + track id for the
/// labelled cars (class 1, vans too), 10000 ("ignore") for cars without a label, 0 elsewhere.
/// Cameras 2 and 3 stand where 0 and 1 do, so P2 = P0 and P3 = P1, labels hold for both, and grey
/// is the luma of colour. A frame has the same bytes whatever range it is written with. Throws
/// std::runtime_error naming the file that cannot be written.
void writeDrive(const DriveOptions& options, const std::filesystem::path& folder,
                const Progress& progress);

}  // namespace djpete::simulator
