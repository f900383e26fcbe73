/// The centre line of a street.
#pragma once

#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete::simulator {

/// A smooth curve on the ground z = 0, measured by arc length s in metres.
class Street {
  public:
    /// Starts at the origin along +x; bends gently, differently for each seed.
    Street(double length_m, uint32_t seed);

    double length_m() const { return static_cast<double>(samples_.size() - 1) * kStep_m; }
    /// Frame on the street: x along it, y to the left, z up; `lateral_m` to the left. Straight on
    /// before its start and after its end.
    geometry::SE3 poseAt(double s_m, double lateral_m = 0) const;

  private:
    static constexpr double kStep_m = 0.5;
    struct Sample {
        double x, y, heading_rad;
    };
    std::vector<Sample> samples_;
};

}  // namespace djpete::simulator
