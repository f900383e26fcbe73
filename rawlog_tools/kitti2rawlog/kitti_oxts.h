/// OXTS packets (GPS and IMU) of KITTI.
#pragma once

#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>

#include <filesystem>
#include <vector>

#include "djpete/geometry/se3.h"
#include "kitti_layout.h"

namespace djpete::kitti2rawlog {

/// What of a packet is kept. Angles in radians: yaw 0 is east, counter-clockwise; acceleration and
/// rates in the IMU's frame (x forward, y left, z up), with gravity.
struct OxtsPacket {
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
    double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
    geometry::Vec3 acceleration{0, 0, 0};  ///< m/s^2
    geometry::Vec3 rate{0, 0, 0};          ///< rad/s
    int satellites = 0;
};

/// Reads the packets of `drive` by frame. Throws InputError naming file and line unless a packet
/// has its 30 numbers.
std::map<uint64_t, OxtsPacket> readOxts(const DriveFiles& drive);

/// A GGA fix. Label and stamps are set.
mrpt::obs::CObservationGPS::Ptr gpsObservation(const OxtsPacket& p, mrpt::Clock::time_point stamp,
                                               const geometry::SE3& T_vehicle_imu);
/// Acceleration, rates and orientation. Label and stamp are set.
mrpt::obs::CObservationIMU::Ptr imuObservation(const OxtsPacket& p, mrpt::Clock::time_point stamp,
                                               const geometry::SE3& T_vehicle_imu);

}  // namespace djpete::kitti2rawlog
