/// A street of boxes, and exact scans of it.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/obs/sensor_frame.h"

namespace made_up {

using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using djpete::geometry::Vec6;

struct Box {
    Vec3 low, high;
};

/// Ground at z = -1.73 (the scanner stands at its usual height) and boxes on it.
struct Street {
    std::vector<Box> boxes;
    bool ground = true;

    /// Distance along a ray; infinite if it meets nothing.
    double cast(const Vec3& from, const Vec3& direction) const {
        double best = std::numeric_limits<double>::infinity();
        if (ground && direction.z() < 0) best = (-1.73 - from.z()) / direction.z();
        for (const auto& box : boxes) {
            double enter = 0, leave = best;
            for (int axis = 0; axis < 3 && enter < leave; ++axis) {
                double a = (box.low[axis] - from[axis]) / direction[axis];
                double b = (box.high[axis] - from[axis]) / direction[axis];
                if (a > b) std::swap(a, b);
                enter = std::max(enter, a);
                leave = std::min(leave, b);
            }
            if (enter < leave && enter > 0) best = enter;
        }
        return best;
    }
};

/// Two rows of houses with gaps between them, set back unevenly, and parked boxes before them.
inline Street houses() {
    Street out;
    for (int i = 0; i < 10; ++i) {
        const double x = -40 + 14.0 * i, back = 0.7 * (i % 3);
        out.boxes.push_back({{x, 7 + back, -1.73}, {x + 11, 20, 6}});
        out.boxes.push_back({{x + 4, -22, -1.73}, {x + 14, -8 - back, 7}});
        out.boxes.push_back({{x + 3, 3.5, -1.73}, {x + 7.2, 5.2, -0.3}});
    }
    return out;
}

/// Two long smooth walls: nothing tells how far along one is.
inline Street corridor() {
    Street out;
    out.boxes.push_back({{-500, 6, -1.73}, {500, 8, 8}});
    out.boxes.push_back({{-500, -8, -1.73}, {500, -6, 8}});
    return out;
}

/// Where the vehicle is `turn` of a revolution (-0.5..0.5) from when the scanner looks ahead.
inline SE3 whileTurning(const SE3& T_world_vehicle, const Vec6& twistPerTurn, double turn) {
    return T_world_vehicle * SE3::exp(twistPerTurn * turn);
}

/// 64 beams, 900 columns, `sigma_m` of Gaussian noise in range; the vehicle's frame is the
/// scanner's. The vehicle moves by `twistPerTurn` during the scan.
inline djpete::obs::LidarScan scanOf(const Street& street, const SE3& T_world_vehicle,
                                     double sigma_m, uint64_t seed,
                                     const Vec6& twistPerTurn = Vec6::Zero()) {
    djpete::obs::LidarScan scan;
    std::mt19937_64 rng(seed);
    const auto uniform = [&] { return (double(rng() >> 11) + 0.5) * 0x1p-53; };
    for (int column = 0; column < 900; ++column) {
        const double turn = (column + 0.5) / 900 - 0.5, azimuth = 2 * M_PI * turn;
        const SE3 T = whileTurning(T_world_vehicle, twistPerTurn, turn);
        for (int beam = 0; beam < 64; ++beam) {
            const double elevation = (2.0 - 26.8 * beam / 63) * M_PI / 180;
            const Vec3 d(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
            const double range = street.cast(T.translation(), T.rotation() * d);
            const double noise =
                sigma_m * std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform());
            if (!(range < 80)) continue;
            const Eigen::Vector3f p = (d * (range + noise)).cast<float>();
            scan.points.push_back({p.x(), p.y(), p.z(), 0.5F});
        }
    }
    return scan;
}

}  // namespace made_up
