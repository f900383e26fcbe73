/// Rectangles around the outline of a cluster.
#pragma once

#include <vector>

#include "djpete/geometry/types.h"

namespace djpete::observers {

/// A rectangle in the x-y plane of velo: axes e1 = (cos, sin)(theta), e2 = e1 turned by +90 deg.
struct Rectangle {
    double theta_rad = 0;                  ///< in [0, pi/2)
    geometry::Vec2 low{0, 0}, high{0, 0};  ///< bounds along (e1, e2)

    geometry::Vec2 axis(int i) const {
        const double c = std::cos(theta_rad), s = std::sin(theta_rad);
        return i == 0 ? geometry::Vec2(c, s) : geometry::Vec2(-s, c);
    }
    /// Point in the rectangle's axes.
    geometry::Vec2 toAxes(const geometry::Vec2& p) const {
        return {axis(0).dot(p), axis(1).dot(p)};
    }
    geometry::Vec2 fromAxes(const geometry::Vec2& q) const {
        return q.x() * axis(0) + q.y() * axis(1);
    }
    geometry::Vec2 centre() const { return fromAxes(0.5 * (low + high)); }
    geometry::Vec2 extent() const { return high - low; }
};

/// The direction at which the points lie closest to the sides of their bounding rectangle: search
/// over [0, 90) degrees, closeness criterion of Zhang et al. 2017 (algorithms 2 and 4), refined to
/// 0.25 degrees. Requires at least one point.
Rectangle fitRectangle(const std::vector<geometry::Vec2>& outline);

/// Mean distance of the outline to the nearer of the two sides that face the sensor (the origin).
double meanDistanceToVisibleSides(const Rectangle& r, const std::vector<geometry::Vec2>& outline);

/// Share of the smaller rectangle's area that both cover.
double overlapOfSmaller(const Rectangle& a, const Rectangle& b);

}  // namespace djpete::observers
