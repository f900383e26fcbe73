#include "djpete/simulator/street.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

Street::Street(double length_m, uint32_t seed) {
    double x = 0, y = 0, heading = 0;
    const double side = unit(hash(seed, 50U)) < 0.5F ? -1.0 : 1.0;
    const auto count = static_cast<std::size_t>(std::ceil(length_m / kStep_m)) + 1;
    for (std::size_t i = 0; i < count; ++i) {
        samples_.push_back({x, y, heading});
        const double s = static_cast<double>(i) * kStep_m;
        // Straight for 25 m, then bends of about 90 m radius to alternating sides.
        const double wave = std::sin((s - 25.0) / 38.0);
        const double curvature = s < 25 ? 0 : side * wave * std::abs(wave) / 90.0;
        x += kStep_m * std::cos(heading + 0.5 * curvature * kStep_m);
        y += kStep_m * std::sin(heading + 0.5 * curvature * kStep_m);
        heading += curvature * kStep_m;
    }
}

geometry::SE3 Street::poseAt(double s_m, double lateral_m) const {
    const double at = std::clamp(s_m / kStep_m, 0.0, static_cast<double>(samples_.size()) - 1.001);
    const auto i = static_cast<std::size_t>(at);
    const double f = at - static_cast<double>(i);
    const Sample &a = samples_[i], &b = samples_[i + 1];
    const double heading = a.heading_rad + f * (b.heading_rad - a.heading_rad);
    const geometry::Vec3 centre(a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), 0);
    const geometry::Vec3 ahead(std::cos(heading), std::sin(heading), 0);
    const geometry::Vec3 left(-std::sin(heading), std::cos(heading), 0);
    const double beyond_m = s_m - at * kStep_m;  // 0 on the street: kStep_m is a power of two
    return geometry::SE3::fromYaw(heading, centre + beyond_m * ahead + lateral_m * left);
}

}  // namespace djpete::simulator
