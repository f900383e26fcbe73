#include "coherent_points.h"

#include <algorithm>
#include <numeric>

#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

constexpr double kSameNormal_cos = 0.5;
constexpr double kLargest_m = 0.15;  ///< radius; keeps far discs from linking everything

}  // namespace

std::vector<bool> coherentPoints(const ObjectModel& model, std::size_t minPoints,
                                 double smallest_m) {
    const PointGrid grid(model, 0.1);
    std::vector<uint32_t> root(model.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&](uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    const auto radiusOf = [&](uint32_t i) {
        const auto radius = static_cast<double>(model.radius_m[i]);
        return std::max(smallest_m, std::min(kLargest_m, radius));
    };
    for (uint32_t i = 0; i < model.size(); ++i) {
        const geometry::Vec3 n = vec3(model.normals[i]);
        const double radius = radiusOf(i);
        // Every pair is met from its larger disc; discs of the same size see each other.
        grid.forWithin(vec3(model.point(i)), 2 * radius, [&](uint32_t j, double d2) {
            const double reach = radius + std::min(radius, radiusOf(j));
            if (d2 > reach * reach || n.dot(vec3(model.normals[j])) < kSameNormal_cos) return;
            root[find(j)] = find(i);
        });
    }
    std::vector<std::size_t> members(model.size(), 0);
    std::size_t most = 0;
    for (uint32_t i = 0; i < model.size(); ++i) most = std::max(most, ++members[find(i)]);
    const std::size_t enough = std::min(minPoints, most / 4);
    std::vector<bool> out(model.size());
    for (uint32_t i = 0; i < model.size(); ++i) out[i] = members[find(i)] >= enough;
    return out;
}

}  // namespace djpete::texture
