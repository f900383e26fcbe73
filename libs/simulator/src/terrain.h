/// Height of the ground.
#pragma once

#include <vector>

#include "djpete/geometry/types.h"

namespace djpete::simulator {

/// A smooth height field over the plane; flat unless made from heights along a way.
class Terrain {
  public:
    static constexpr double kCell_m = 4.0;  ///< bilinear within cells aligned with the origin

    Terrain() = default;
    /// Passes near the points (x, y, z) of a way, blending where it meets itself; levels out around
    /// them.
    explicit Terrain(const std::vector<geometry::Vec3>& way);

    double height_m(const geometry::Vec2& p) const;
    /// Lowest height there is.
    double lowest_m() const { return lowest_m_; }

  private:
    int x0_ = 0, y0_ = 0, nx_ = 0, ny_ = 0;  // cells
    double lowest_m_ = 0;
    std::vector<double> heights_;
};

}  // namespace djpete::simulator
