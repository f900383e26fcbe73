/// Sides of a box, measured one by one.
#pragma once

#include <optional>
#include <vector>

#include "djpete/backend/box_from_points.h"

namespace djpete::backend {

/// A number and its 1-sigma.
struct Measured {
    double value = 0, sigma = 0;
};

/// Points in the frame of the present estimate, only those that may belong to the box.
using SidePoints = std::vector<geometry::Vec3>;

/// Turn of a flat side against the box's x axis, and where it is at x = 0 of the points' frame.
struct SideLine {
    Measured turn_rad;
    double y_m = 0;  ///< of the flat part
    double outermost_m = 0;  ///< outermost supported point: mirrors, handles
};
/// The long side at y > 0 (sign 1) or y < 0 (sign -1), near y = sign * width / 2.
std::optional<SideLine> fitSide(const SidePoints& points, int sign, double width_m,
                                double search_rad);

/// Where the end at x > 0 (sign 1) or x < 0 (sign -1) is, if enough of it was seen.
std::optional<double> fitEnd(const SidePoints& points, int sign, const geometry::Vec3& size_m);

/// The largest value that at least three points reach; -infinity if there are fewer.
double outermost(std::vector<double> values);

}  // namespace djpete::backend
