/// Boxes on the plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "djpete/geometry/se3.h"

namespace djpete::simulator {

/// Free space between two boxes seen from above, in m, measured along their sides; negative where
/// they overlap. Poses of their middles.
inline double gapBetween(const geometry::SE3& T_world_a, const geometry::Vec3& size_a,
                         const geometry::SE3& T_world_b, const geometry::Vec3& size_b) {
    const auto reach = [](const geometry::Vec3& axis, const geometry::SE3& T,
                          const geometry::Vec3& size) {
        return 0.5 * (std::abs(axis.dot(T.rotation().col(0))) * size.x() +
                      std::abs(axis.dot(T.rotation().col(1))) * size.y());
    };
    const geometry::Vec3 between = T_world_b.translation() - T_world_a.translation();
    double gap = -1e9;
    for (const auto* T : {&T_world_a, &T_world_b}) {
        for (int k = 0; k < 2; ++k) {
            const geometry::Vec3 axis = T->rotation().col(k);
            gap = std::max(gap, std::abs(axis.dot(between)) - reach(axis, T_world_a, size_a) -
                                    reach(axis, T_world_b, size_b));
        }
    }
    return gap;
}

}  // namespace djpete::simulator
