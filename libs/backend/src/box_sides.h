/// Sides of a box, measured one by one.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <utility>
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

/// The largest value that at least three of those added reach: a single stray point does not count.
class Outermost {
  public:
    void add(double value) {
        if (value <= best_[2]) return;
        best_[2] = value;
        if (best_[2] > best_[1]) std::swap(best_[1], best_[2]);
        if (best_[1] > best_[0]) std::swap(best_[0], best_[1]);
    }
    /// -infinity if fewer than three were added.
    double value() const { return best_[2]; }

  private:
    static constexpr double kNone = -std::numeric_limits<double>::infinity();
    std::array<double, 3> best_{kNone, kNone, kNone};
};

}  // namespace djpete::backend
