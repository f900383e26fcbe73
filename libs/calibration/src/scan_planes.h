/// Planes through a scan's points about a pixel.
#pragma once

#include <optional>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::calibration {

/// The points p with n . p = 1, in cam.
struct Plane {
    geometry::Vec3 n;
    double sigma = 0;  ///< relative standard deviation of 1/z at the pixel
};

/// A scan as a camera at T_cam_velo sees it.
class ScanView {
  public:
    ScanView(const std::vector<Eigen::Vector3f>& points_velo, const geometry::SE3& T_cam_velo,
             const geometry::StereoCamera& camera);
    /// A flat piece of surface at pixel (u, v), with points on all sides of it.
    std::optional<Plane> planeAt(double u_px, double v_px) const;

  private:
    struct Return {
        float x, y, w;  ///< ray at z = 1, and 1/z
    };
    geometry::StereoCamera camera_;
    int columns_, rows_;
    std::vector<std::vector<Return>> cells_;
};

}  // namespace djpete::calibration
