/// Points that a scanner gets from the sides of a box it sees, and from the ground around it.
#pragma once

#include <cmath>
#include <memory>

#include "djpete/geometry/se3.h"
#include "djpete/obs/object_points.h"
#include "djpete_test/synthetic_drive.h"

namespace djpete_test {

/// In the frame a of T_a_box; the scanner stands at `origin_a`.
inline djpete::obs::ObjectPoints scannedBox(const djpete::geometry::SE3& T_a_box,
                                            const djpete::geometry::Vec3& size_m,
                                            const djpete::geometry::Vec3& origin_a, Random& random,
                                            double step_m = 0.12, double noise_m = 0.01) {
    using djpete::geometry::Vec3;
    djpete::obs::ObjectPoints out;
    out.origin = origin_a.cast<float>();
    const Vec3 origin = T_a_box.inverse() * origin_a, half = 0.5 * size_m;
    const auto put = [&](auto& list, const Vec3& p_box) {
        list.push_back((T_a_box * (p_box + random.normal3(noise_m))).cast<float>());
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int sign = origin[axis] > half[axis] ? 1 : origin[axis] < -half[axis] ? -1 : 0;
        if (sign == 0) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (double a = -half[u]; a <= half[u]; a += step_m) {
            for (double b = -half[v]; b <= half[v]; b += step_m) {
                Vec3 p;
                p[axis] = sign * half[axis];
                p[u] = a;
                p[v] = b;
                if (p.z() > 0.15 - half.z()) put(out.body, p);
            }
        }
    }
    for (double a = -half.x() - 0.6; a <= half.x() + 0.6; a += 0.5) {
        put(out.ground, Vec3(a, -half.y() - 0.4, -half.z()));
        put(out.ground, Vec3(a, half.y() + 0.4, -half.z()));
    }
    return out;
}

}  // namespace djpete_test
