/// The edge between the project's SE3 and MRPT's poses.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include "djpete/geometry/se3.h"

namespace djpete::geometry {

mrpt::poses::CPose3D toCPose3D(const SE3& T_a_b);
SE3 fromCPose3D(const mrpt::poses::CPose3D& T_a_b);

/// The rotation that takes optical axes (z forward, x right, y down) to vehicle axes (x forward,
/// y left, z up): a camera at the vehicle's origin that looks ahead.
SE3 opticalToVehicleAxes();

}  // namespace djpete::geometry
