/// Depth of image features from a LiDAR scan.
#pragma once

#include <optional>
#include <vector>

#include "djpete/frontend/options.h"
#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::frontend {

struct LidarDepth {
    float depth_m = 0;  ///< z in cam
    float sigma_m = 0;
};

/// A scan seen from the camera, in cells for quick look-up.
class ProjectedScan {
  public:
    ProjectedScan(const obs::LidarScan& scan, const obs::RigCamera& camera,
                  const FrontendOptions& options);

    /// Fits the plane (1/z is affine in u, v on a plane) through the returns about the pixel.
    /// Nothing if they do not surround it or do not lie on one plane: at a depth edge it is not
    /// known which side the corner belongs to.
    std::optional<LidarDepth> depthAt(double u_px, double v_px) const;

  private:
    struct Return {
        float u_px, v_px, inverseDepth;
    };
    const std::vector<Return>* cellAt(int column, int row) const;

    FrontendOptions options_;
    int columns_ = 0, rows_ = 0;
    std::vector<std::vector<Return>> cells_;
};

}  // namespace djpete::frontend
