#include "terrain.h"

#include <algorithm>
#include <cmath>

namespace djpete::simulator {

using geometry::Vec2;
using geometry::Vec3;

Terrain::Terrain(const std::vector<Vec3>& way) {
    constexpr double kMargin_m = 120, kSpacing_m = 3, kBlur_m = 5;
    std::vector<Vec3> points;
    Vec3 low = way.front(), high = way.front();
    for (const auto& p : way) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
        if (points.empty() || (p - points.back()).norm() > kSpacing_m) points.push_back(p);
    }
    const auto cell = [](double x) { return static_cast<int>(std::floor(x / kCell_m)); };
    x0_ = cell(low.x() - kMargin_m);
    y0_ = cell(low.y() - kMargin_m);
    nx_ = cell(high.x() + kMargin_m) - x0_ + 2;
    ny_ = cell(high.y() + kMargin_m) - y0_ + 2;
    lowest_m_ = high.z();
    for (int y = 0; y < ny_; ++y) {
        for (int x = 0; x < nx_; ++x) {
            const Vec2 at((x0_ + x) * kCell_m, (y0_ + y) * kCell_m);
            double sum = 0, weights = 0;
            for (const auto& p : points) {
                const double d2 = (p.head<2>() - at).squaredNorm() + kBlur_m * kBlur_m;
                const double w = 1.0 / (d2 * d2);
                sum += w * p.z();
                weights += w;
            }
            heights_.push_back(sum / weights);
            lowest_m_ = std::min(lowest_m_, heights_.back());
        }
    }
}

double Terrain::height_m(const Vec2& p) const {
    if (heights_.empty()) return 0;
    const double x = std::clamp(p.x() / kCell_m - x0_, 0.0, nx_ - 1.001);
    const double y = std::clamp(p.y() / kCell_m - y0_, 0.0, ny_ - 1.001);
    const auto ix = static_cast<std::size_t>(x), iy = static_cast<std::size_t>(y);
    const double fx = x - static_cast<double>(ix), fy = y - static_cast<double>(iy);
    const std::size_t n = static_cast<std::size_t>(nx_), at = iy * n + ix;
    return (1 - fy) * ((1 - fx) * heights_[at] + fx * heights_[at + 1]) +
           fy * ((1 - fx) * heights_[at + n] + fx * heights_[at + n + 1]);
}

}  // namespace djpete::simulator
