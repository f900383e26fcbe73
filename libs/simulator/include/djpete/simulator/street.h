/// The centre line of a street.
#pragma once

#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete::simulator {

/// A smooth plane curve, measured by arc length s in metres.
class Street {
  public:
    /// Starts at the origin along +x; bends gently, differently for each seed.
    Street(double length_m, uint32_t seed);
    /// Through points of the plane at most a few metres apart, rounded over about `smooth_m`.
    Street(const std::vector<geometry::Vec2>& points, double smooth_m);

    double length_m() const { return static_cast<double>(samples_.size() - 1) * kStep_m; }
    /// Frame on the street at z = 0: x along it, y to the left, z up; `lateral_m` to the left.
    /// Straight on before its start and after its end.
    geometry::SE3 poseAt(double s_m, double lateral_m = 0) const;

    /// Radians per metre, to the left.
    double curvatureAt(double s_m) const;

  private:
    static constexpr double kStep_m = 0.5;
    struct Sample {
        double x, y, heading_rad;
    };
    std::vector<Sample> samples_;
};

}  // namespace djpete::simulator
