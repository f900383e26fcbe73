/// KITTI's calibration files, in all the spellings of its benchmarks.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "djpete/obs/calibration.h"

namespace djpete::kitti2rawlog {

using Projection = Eigen::Matrix<double, 3, 4>;

struct ImageSize {
    int width_px = 0, height_px = 0;
    friend bool operator==(ImageSize a, ImageSize b) {
        return a.width_px == b.width_px && a.height_px == b.height_px;
    }
};

/// What KITTI says of its rig. The vehicle frame is the Velodyne's; `cam0` is the rectified camera
/// 0, in which KITTI's labels and poses are given.
struct KittiCalibration {
    std::string origin;                            ///< file, for messages
    std::array<std::optional<Projection>, 4> P;    ///< rectified cam0 to image i, pixels
    std::array<std::optional<ImageSize>, 4> size;  ///< where the file tells (raw layout)
    std::optional<geometry::SE3> T_cam0_velo;
    std::optional<geometry::SE3> T_velo_imu;

    /// inverse(T_cam0_velo); without a Velodyne calibration the vehicle sits in camera 0 and only
    /// its axes differ (x forward, y left, z up).
    geometry::SE3 T_vehicle_cam0() const;
    /// Camera i as a rectified camera at cam0 + x, x = -P_i(0,3)/P_i(0,0) (KITTI's y and z offsets
    /// of cameras 2 and 3, some mm, are dropped as a rectified pair must have none). With `right`,
    /// the baseline to that camera. Throws InputError if P_i is missing or no rectified pair.
    obs::RigCamera rigCamera(std::size_t left, std::optional<std::size_t> right,
                             ImageSize imageSize) const;
    /// Position of camera i along cam0's x axis. Throws InputError if P_i is missing.
    double cameraOffset_m(std::size_t i) const;
};

/// calib.txt of odometry (P0..P3, Tr) and NNNN.txt of tracking and object (P0..P3, R_rect or
/// R0_rect, Tr_velo_cam or Tr_velo_to_cam, Tr_imu_velo or Tr_imu_to_velo).
/// Throws InputError naming file and line.
KittiCalibration readCalibrationFile(const std::filesystem::path& file);

/// calib_cam_to_cam.txt, and if present calib_velo_to_cam.txt and calib_imu_to_velo.txt, of a raw
/// day. Throws InputError naming file and line.
KittiCalibration readRawCalibration(const std::filesystem::path& folder);

}  // namespace djpete::kitti2rawlog
