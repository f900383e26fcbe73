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
    std::size_t pieces = 0;  ///< of a quarter metre in which it was seen
    double y_m = 0;          ///< of the flat part
    double outermost_m = 0;  ///< outermost supported point: mirrors, handles
};
/// The long side at y > 0 (sign 1) or y < 0 (sign -1), within `slack_m` of y = sign * width / 2.
std::optional<SideLine> fitSide(const SidePoints& points, int sign, double width_m,
                                double search_rad, double slack_m);

/// Where the end at x > 0 (sign 1) or x < 0 (sign -1) is, if enough of it was seen; within
/// `slack_m` of x = sign * length / 2, or farther in.
std::optional<double> fitEnd(const SidePoints& points, int sign, const geometry::Vec3& size_m,
                             double slack_m);

/// The largest value that at least three points reach; -infinity if there are fewer.
double outermost(std::vector<double> values);

}  // namespace djpete::backend
