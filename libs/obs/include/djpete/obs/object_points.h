/// The LiDAR returns around one detection.
#pragma once

#include <memory>
#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete::obs {

/// Thinned returns of one scan in and around an object's box. They belong to the object: they never
/// become points of the map. All in one frame, metres: that of the detection's sensor, or `cam`
/// once in the map.
struct ObjectPoints {
    using Point = Eigen::Vector3f;
    std::vector<Point> body;    ///< off the ground, in the box grown by a margin
    std::vector<Point> ground;  ///< of the ground beside and below the box
    Point origin{0, 0, 0};      ///< of the scanner

    /// The same in another frame a; T_a_b with b the present one.
    ObjectPoints in(const geometry::SE3& T_a_b) const;
};

using ObjectPointsPtr = std::shared_ptr<const ObjectPoints>;

}  // namespace djpete::obs
