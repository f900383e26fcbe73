#include "djpete/texture/free_space.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace djpete::texture {

namespace {

using geometry::Vec3;

std::optional<std::size_t> cellOf(const FreeSpace& space, const Vec3& p_obj) {
    std::array<std::size_t, 3> at{};
    for (unsigned i = 0; i < 3; ++i) {
        const double c = std::floor((p_obj[i] - static_cast<double>(space.low_m[i])) /
                                    static_cast<double>(FreeSpace::kCell_m));
        if (!(c >= 0 && c < space.cells[i])) return std::nullopt;
        at[i] = static_cast<std::size_t>(c);
    }
    return (at[2] * space.cells[1] + at[1]) * space.cells[0] + at[0];
}

void count(uint8_t& cell) {
    if (cell < 255) ++cell;
}

/// The share of the way from a to b that lies in the grid; nothing if none does.
std::optional<std::array<double, 2>> within(const FreeSpace& space, const Vec3& a, const Vec3& b) {
    double enter = 0, leave = 1;
    for (unsigned i = 0; i < 3; ++i) {
        const auto low = static_cast<double>(space.low_m[i]);
        const double high = low + static_cast<double>(FreeSpace::kCell_m) * space.cells[i];
        const double way = b[i] - a[i];
        if (std::abs(way) < 1e-12) {
            if (a[i] < low || a[i] > high) return std::nullopt;
            continue;
        }
        const double s = (low - a[i]) / way, t = (high - a[i]) / way;
        enter = std::max(enter, std::min(s, t));
        leave = std::min(leave, std::max(s, t));
    }
    if (enter >= leave) return std::nullopt;
    return std::array<double, 2>{enter, leave};
}

}  // namespace

void FreeSpace::reset(const Vec3& size_m) {
    std::size_t total = 1;
    for (unsigned i = 0; i < 3; ++i) {
        const double cell = static_cast<double>(kCell_m);
        const double half = std::clamp(0.5 * size_m[i], cell, 20.0) + cell;
        cells[i] = static_cast<uint16_t>(std::ceil(2 * half / cell));
        low_m[i] = -0.5F * kCell_m * static_cast<float>(cells[i]);
        total *= cells[i];
    }
    passed.assign(total, 0);
    hits.assign(total, 0);
}

void FreeSpace::addRay(const Vec3& sensor_obj, const Vec3& end_obj) {
    if (empty()) return;
    if (const auto end = cellOf(*this, end_obj)) count(hits[*end]);
    const Vec3 way = end_obj - sensor_obj;
    const double length = way.norm(), cell = static_cast<double>(kCell_m);
    if (!(length > cell)) return;
    // The last cell and a half are left out: the surface is there, give or take the noise.
    const Vec3 last = sensor_obj + way * (1 - std::min(1.0, 1.5 * cell / length));
    const auto share = within(*this, sensor_obj, last);
    if (!share) return;
    const Vec3 first = sensor_obj + (last - sensor_obj) * (*share)[0];
    const Vec3 inside = (last - sensor_obj) * ((*share)[1] - (*share)[0]);
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * inside.norm() / cell)));
    std::optional<std::size_t> before;
    for (int k = 0; k < steps; ++k) {
        const auto at = cellOf(*this, first + inside * ((k + 0.5) / steps));
        if (at && at != before) count(passed[*at]);
        before = at;
    }
}

bool FreeSpace::isFree(const Vec3& p_obj) const {
    if (empty()) return false;
    const auto at = cellOf(*this, p_obj);
    return at && passed[*at] >= kSureRays && passed[*at] > 2 * hits[*at];
}

}  // namespace djpete::texture
