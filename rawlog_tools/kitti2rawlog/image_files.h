/// Cheap looks at image and scan files, and the instance masks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "djpete/obs/detection.h"
#include "kitti_calibration.h"

namespace djpete::kitti2rawlog {

/// Size from the first 24 bytes; nothing is decoded. Throws InputError if it is no PNG.
ImageSize pngSize(const std::filesystem::path& file);

/// Throws InputError unless `file` holds a whole, positive number of 16-byte points.
void checkScanSize(const std::filesystem::path& file);

/// Gives each detection with a track number its mask from a 16-bit PNG of instance numbers (KITTI
/// MOTS: class * 1000 + track; 10000 means ignore). Throws InputError if the file cannot be
/// decoded or has another size than the images.
void attachMasks(const std::filesystem::path& file, ImageSize expected,
                 std::vector<obs::ObjectDetection>& detections);

}  // namespace djpete::kitti2rawlog
