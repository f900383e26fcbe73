/// Files that say where the sensors are: calibration, times, poses.
#pragma once

#include <filesystem>

#include "djpete/geometry/camera.h"
#include "djpete/simulator/faults.h"
#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// calib.txt with P0 .. P3 and Tr, and calib_imu_to_velo.txt as KITTI's raw data has it; wrong if
/// faults say so. Throws std::runtime_error naming the file.
void writeCalibration(const geometry::StereoCamera& camera, const geometry::SE3& T_vehicle_cam,
                      const std::vector<Fault>& faults, const std::filesystem::path& folder);
/// times.txt and poses.txt of the frames 0 .. end-1. Times jump if faults say so.
void writeTimesAndPoses(const World& world, uint64_t end, const geometry::SE3& T_vehicle_cam,
                        const std::vector<Fault>& faults, const std::filesystem::path& folder);

}  // namespace djpete::simulator
