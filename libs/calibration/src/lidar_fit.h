/// Stereo and scan, aligned: tilt and shift of the camera, scale and offset of disparities.
#pragma once

#include <vector>

#include "djpete/obs/calibration.h"
#include "right_match.h"
#include "robust_fit.h"

namespace djpete::calibration {

/// What is kept of a frame with a scan.
struct ScanFrame {
    std::size_t number = 0;
    obs::RigCamera camera;
    geometry::SE3 T_vehicle_velo;
    std::vector<Eigen::Vector3f> points_velo;
    std::vector<RightMatch> matches;
};

/// Order of the solution: offset (px), scale - 1, shift x, y, z (m, cam), turn x, y, z (rad, cam).
struct LidarFit {
    LinearFit<8> fit;
    double rms_px = 0;
};

/// Iterates association (the plane of the scan at each corner, seen from the camera as corrected so
/// far) and adjustment. With the plane n . p = 1 in cam and r = ((u - cx) / fx, (v - cy) / fy, 1),
/// 1/z = n . r, and a disparity is predicted as scale * fx * baseline * (n . r) + offset. Under
/// T_vehicle_cam <- T_vehicle_cam exp(rho, phi) it holds to first order that
///     d(1/z) = (n . r) (n . rho) + (r x n) . phi.
LidarFit fitLidar(const std::vector<ScanFrame>& frames);

}  // namespace djpete::calibration
