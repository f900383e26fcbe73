/// Point-to-plane alignment of one scan with the local map.
#pragma once

#include <optional>
#include <vector>

#include "djpete/geometry/se3.h"
#include "plane_map.h"

namespace djpete::scans {

struct Alignment {
    geometry::SE3 T_map_vehicle;
    /// Of T_map_vehicle, in the vehicle's frame. Large where the planes leave a direction open.
    geometry::Mat6 covariance;
    std::size_t matched = 0;  ///< points near a plane
    double rms_m = 0;         ///< weighted distance to the planes
};

/// Moves `points` (vehicle) from the predicted pose onto the planes of `map`; `kernel_m` is the
/// width of Geman and McClure's kernel. Directions that the planes leave open stay as predicted.
/// Nothing if too few points are on planes.
std::optional<Alignment> align(const std::vector<geometry::Vec3>& points, PlaneMap& map,
                               const geometry::SE3& T_map_vehicle_predicted, double kernel_m,
                               const ScanOptions& options);

}  // namespace djpete::scans
