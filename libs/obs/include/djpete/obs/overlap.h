/// Intersection over union of boxes.
#pragma once

#include "djpete/geometry/se3.h"
#include "djpete/obs/detection.h"

namespace djpete::obs {

/// A box standing upright in `world`.
struct UprightBox {
    geometry::Vec3 centre{0, 0, 0};
    double yaw_rad = 0;
    geometry::Vec3 size_m{0, 0, 0};  ///< (length, width, height)

    /// Grown by `margin_m` on every side.
    UprightBox grown(double margin_m) const {
        return {centre, yaw_rad, size_m + geometry::Vec3::Constant(2 * margin_m)};
    }
};
/// The upright box nearest to a posed one (its roll and pitch are dropped).
UprightBox uprightBox(const geometry::SE3& T_world_obj, const geometry::Vec3& size_m);

/// Overlap of the ground rectangles, 0..1.
double birdsEyeOverlap(const UprightBox& a, const UprightBox& b);
/// Overlap of the volumes, 0..1.
double volumeOverlap(const UprightBox& a, const UprightBox& b);
double imageOverlap(const ImageBox& a, const ImageBox& b);

}  // namespace djpete::obs
