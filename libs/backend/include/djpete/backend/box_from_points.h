/// Where an object's box is, by the LiDAR points on it.
#pragma once

#include <optional>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/obs/object_points.h"

namespace djpete::backend {

/// What is known of a box before its points are looked at. The box stands upright in its own frame
/// `obj`, so four numbers place it: x, y, z (m) and yaw (rad).
struct BoxPrior {
    geometry::Vec3 size_m{0, 0, 0};
    geometry::Vec3 sizeSigma_m{0.05, 0.05, 0.05};
    geometry::Vec3 sigma_m{0.1, 0.1, 0.1};  ///< of its centre, in obj
    double yawSigma_rad = 0.02;
};

/// Points of one or more views of one object, in the prior's obj.
struct BoxPoints {
    std::vector<obs::ObjectPoints::Point> body, ground;
    std::vector<obs::ObjectPoints::Point> origins;  ///< of the scanner, one per view
};

/// A box fitted to points; `fitted` is its frame.
struct BoxFit {
    geometry::SE3 T_obj_fitted;  ///< x, y, z and yaw only
    geometry::Vec3 size_m{0, 0, 0};
    geometry::Vec3 sigma_m{0, 0, 0};  ///< of the centre, in fitted
    double yawSigma_rad = 0;
    /// Sides that the points showed: rear, front, right, left, bottom (by the ground), top.
    bool rear = false, front = false, right = false, left = false, bottom = false, top = false;
};

/// Maximum a posteriori box. Sides that face a scanner lie where the points end; a box holds its
/// points, so an unseen side is at least as far out as they are; it stands on the ground. The rest
/// is the prior's. Nothing if the points show no side. Deterministic.
std::optional<BoxFit> fitBox(const BoxPoints& points, const BoxPrior& prior);

}  // namespace djpete::backend
