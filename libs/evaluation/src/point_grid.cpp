#include "point_grid.h"

#include <algorithm>
#include <cmath>

namespace djpete::evaluation {

PointGrid::PointGrid(const std::vector<std::array<float, 3>>& points, double reach)
    : reach_(static_cast<float>(reach)) {
    entries_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& p = points[i];
        entries_.push_back(
            {keyOf(cell(p[0]), cell(p[1]), cell(p[2])), static_cast<uint32_t>(i), p});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
}

int64_t PointGrid::cell(float x) const { return static_cast<int64_t>(std::floor(x / reach_)); }

uint64_t PointGrid::keyOf(int64_t x, int64_t y, int64_t z) {
    constexpr int64_t kHalf = int64_t{1} << 20U;
    return (static_cast<uint64_t>(x + kHalf) << 42U) | (static_cast<uint64_t>(y + kHalf) << 21U) |
           static_cast<uint64_t>(z + kHalf);
}

const PointGrid::Entry* PointGrid::lower(uint64_t key) const {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                                     [](const Entry& e, uint64_t k) { return e.key < k; });
    return entries_.data() + (at - entries_.begin());
}

}  // namespace djpete::evaluation
