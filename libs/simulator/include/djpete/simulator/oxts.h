/// GPS and inertial unit of the own vehicle, as KITTI's raw data has it.
#pragma once

#include <string>

#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// Sigmas of an OXTS unit with corrections. Position and angles err slowly (a new error every five
/// seconds or so), all else is white.
struct OxtsNoise {
    double position_m = 0.03;        ///< per axis
    double angle_rad = 0.0005;       ///< roll, pitch and yaw
    double velocity_mps = 0.02;      ///< per axis
    double acceleration_mps2 = 0.1;  ///< per axis
    double turnRate_radps = 0.002;   ///< per axis
};

/// The unit in the vehicle: x forward, y to the left, z up.
geometry::SE3 T_velo_imu();

/// Where the unit is at frame 0. Its world has x to the east, y to the north and z up.
struct GeoOrigin {
    double lat_deg = 49.0, lon_deg = 8.4, alt_m = 115.0;
};

/// The 30 numbers of KITTI's raw data at a frame: lat lon alt roll pitch yaw vn ve vf vl vu ax ay
/// az af al au wx wy wz wf wl wu pos_accuracy vel_accuracy navstat numsats posmode velmode orimode.
/// Positions follow Mercator's projection, scaled at the origin's latitude. Accelerations hold
/// gravity.
std::string oxtsRow(const World& world, uint64_t frame, const OxtsNoise& noise,
                    const GeoOrigin& origin = {});

}  // namespace djpete::simulator
