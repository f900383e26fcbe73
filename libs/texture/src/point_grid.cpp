#include "point_grid.h"

#include <algorithm>
#include <cmath>

#include "vectors.h"

namespace djpete::texture {

namespace {

constexpr int64_t kHalf = 1 << 20;

}  // namespace

PointGrid::PointGrid(const ObjectModel& model, double cell_m, const Use& use) : cell_m_(cell_m) {
    entries_.reserve(model.size());
    for (uint32_t i = 0; i < model.size(); ++i) {
        if (use && !use(i)) continue;
        const geometry::Vec3 p = vec3(model.point(i));
        entries_.push_back({keyOf(cellOf(p.x()), cellOf(p.y()), cellOf(p.z())), i, p});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
}

int64_t PointGrid::cellOf(double coordinate_m) const {
    const double cell = std::floor(coordinate_m / cell_m_);
    constexpr auto kLimit = static_cast<double>(kHalf - 1);
    return static_cast<int64_t>(std::clamp(cell, -kLimit, kLimit));
}

uint64_t PointGrid::keyOf(int64_t x, int64_t y, int64_t z) {
    return (static_cast<uint64_t>(x + kHalf) << 42U) | (static_cast<uint64_t>(y + kHalf) << 21U) |
           static_cast<uint64_t>(z + kHalf);
}

std::vector<PointGrid::Entry>::const_iterator PointGrid::firstFrom(uint64_t key) const {
    return std::lower_bound(entries_.begin(), entries_.end(), key,
                            [](const Entry& e, uint64_t k) { return e.key < k; });
}

std::optional<uint32_t> PointGrid::nearest(const geometry::Vec3& p_obj, double radius_m) const {
    std::optional<uint32_t> best;
    double best2 = 0;
    forWithin(p_obj, radius_m, [&](uint32_t i, double d2) {
        if (best && (d2 > best2 || (d2 == best2 && i > *best))) return;
        best = i;
        best2 = d2;
    });
    return best;
}

}  // namespace djpete::texture
