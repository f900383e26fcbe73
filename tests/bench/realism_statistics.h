/// What is measured of a drive, to set simulated drives beside real ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "realism_drive.h"

namespace djpete_bench {

/// One row of the table. No value: the drive has no data for it.
struct Statistic {
    std::string name;  ///< with its unit
    std::optional<double> value;
    bool information = false;  ///< printed, never judged: a choice of the drive, not of realism
};
using Statistics = std::vector<Statistic>;

/// The value below which `share` (0..1) of all lie; nothing if there are none.
std::optional<double> percentile(std::vector<double> values, double share);
std::optional<double> mean(const std::vector<double>& values);

/// Corners, gradients, grey levels and noise of the left images.
Statistics imageStatistics(const RealismDrive& drive);
/// Length of tracks from image to image.
Statistics trackStatistics(const RealismDrive& drive);
/// Disparities, and how alike left and right images are.
Statistics stereoStatistics(const RealismDrive& drive);
/// Points per scan and per car; `cars` is the drive whose labels are used (often `drive` itself).
Statistics lidarStatistics(const RealismDrive& drive, const RealismDrive& cars);
/// The project's own visual odometry on stereo images.
Statistics odometryStatistics(const RealismDrive& drive);

}  // namespace djpete_bench
