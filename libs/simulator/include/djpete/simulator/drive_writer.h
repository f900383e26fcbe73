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
    bool scans = true;
    LidarOptions lidar;
    LabelOptions labels;
    DetectorNoise detector;
    unsigned threads = 2;
};

/// Called after each frame with how many are done and how many there are.
using Progress = std::function<void(uint64_t done, uint64_t all)>;

/// Writes image_0 .. image_3, velodyne, instances (16 bit, 1000 * class + track id as KITTI MOTS),
/// calib.txt, times.txt, poses.txt, label_02.txt and detections.txt (the labels as a noisy detector
/// would give them). Rows of times.txt and poses.txt start at frame 0. Cameras 2 and 3 stand where
/// 0 and 1 do; grey is the luma of colour. Throws std::runtime_error naming the file that cannot be
/// written.
void writeDrive(const DriveOptions& options, const std::filesystem::path& folder,
                const Progress& progress);

}  // namespace djpete::simulator
