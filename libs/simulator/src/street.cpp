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

Street::Street(const std::vector<geometry::Vec2>& points, double smooth_m) {
    using geometry::Vec2;
    // Evenly spaced, then a moving Gaussian mean that shrinks towards the ends, then evenly again.
    const auto even = [](const std::vector<Vec2>& line) {
        std::vector<Vec2> out{line.front()};
        double left_m = kStep_m;
        for (std::size_t i = 1; i < line.size(); ++i) {
            Vec2 from = line[i - 1];
            for (double way = (line[i] - from).norm(); way >= left_m;
                 way = (line[i] - from).norm()) {
                from += left_m / way * (line[i] - from);
                out.push_back(from);
                left_m = kStep_m;
            }
            left_m -= (line[i] - from).norm();
        }
        if (out.size() < 2) out.push_back(out.front() + Vec2(kStep_m, 0));
        return out;
    };
    const std::vector<Vec2> raw = even(points);
    const auto n = static_cast<int>(raw.size()), reach = static_cast<int>(3 * smooth_m / kStep_m);
    std::vector<Vec2> mean;
    for (int i = 0; i < n; ++i) {
        const int r = std::min({reach, i, n - 1 - i});
        Vec2 sum(0, 0);
        double weights = 0;
        for (int k = -r; k <= r; ++k) {
            const double x = k * kStep_m / smooth_m, w = std::exp(-0.5 * x * x);
            sum += w * raw[static_cast<std::size_t>(i + k)];
            weights += w;
        }
        mean.push_back(sum / weights);
    }
    const std::vector<Vec2> line = even(mean);
    double heading = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Vec2 d = line[std::min(i + 1, line.size() - 1)] - line[i == 0 ? 0 : i - 1];
        const double at = std::atan2(d.y(), d.x());
        heading = i == 0 ? at : heading + std::remainder(at - heading, 2 * M_PI);
        samples_.push_back({line[i].x(), line[i].y(), heading});
    }
}

double Street::curvatureAt(double s_m) const {
    const auto i = static_cast<std::size_t>(
        std::clamp(s_m / kStep_m, 2.0, std::max(2.0, static_cast<double>(samples_.size()) - 3.0)));
    if (samples_.size() < 5) return 0;
    return (samples_[i + 2].heading_rad - samples_[i - 2].heading_rad) / (4 * kStep_m);
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
