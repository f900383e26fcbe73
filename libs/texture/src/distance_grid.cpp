#include "distance_grid.h"

#include <algorithm>
#include <cmath>

#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr double kMaxReach_m = 0.75;
constexpr double kMaxCorners = 6e6;

/// Discs smaller than a cell would leave holes between corners.
double radiusOf(const ObjectModel& model, std::size_t i, double voxel_m) {
    return std::max(static_cast<double>(model.radius_m[i]), 0.8 * voxel_m);
}

}  // namespace

DistanceGrid::DistanceGrid(const ObjectModel& model, const MeshOptions& options)
    : voxel_m_(options.voxel_m) {
    if (model.size() == 0) return;
    place(model, options);
    for (std::size_t i = 0; i < model.size(); ++i) {
        const double radius = radiusOf(model, i, voxel_m_);
        splat(vec3(model.point(i)), vec3(model.normals[i]), radius,
              std::min(kMaxReach_m, options.support_radii * radius));
    }
    for (Corner& c : corners_) {
        if (c.weight > 0) c.distance /= c.weight;
    }
}

void DistanceGrid::place(const ObjectModel& model, const MeshOptions& options) {
    Vec3 low = vec3(model.point(0)), high = low;
    double reach = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        low = low.cwiseMin(vec3(model.point(i)));
        high = high.cwiseMax(vec3(model.point(i)));
        reach = std::max(reach, options.support_radii * radiusOf(model, i, voxel_m_));
    }
    if (options.close) {
        low = low.cwiseMin(-0.5 * model.size_m);
        high = high.cwiseMax(0.5 * model.size_m);
    }
    reach = std::min(reach, kMaxReach_m);
    for (;; voxel_m_ *= 1.25) {
        double total = 1;
        for (unsigned i = 0; i < 3; ++i) {
            const double cells = std::ceil((high[i] - low[i] + 2 * reach) / voxel_m_) + 3;
            total *= cells;
            size_[i] = static_cast<int>(std::min(cells, 1e6));
        }
        if (total <= kMaxCorners) break;
    }
    low_obj_ = low - Vec3::Constant(reach + voxel_m_);
    corners_.resize(index(0, 0, size_[2]));
}

void DistanceGrid::splat(const Vec3& p, const Vec3& n, double radius_m, double reach_m) {
    int from[3], to[3];
    for (int i = 0; i < 3; ++i) {
        const double middle = p[i] - low_obj_[i];
        from[i] = std::max(0, static_cast<int>(std::ceil((middle - reach_m) / voxel_m_)));
        to[i] = std::min(size_[static_cast<unsigned>(i)] - 1,
                         static_cast<int>(std::floor((middle + reach_m) / voxel_m_)));
    }
    const double spread = 0.8 * radius_m;
    for (int z = from[2]; z <= to[2]; ++z) {
        for (int y = from[1]; y <= to[1]; ++y) {
            for (int x = from[0]; x <= to[0]; ++x) {
                const Vec3 way = position(x, y, z) - p;
                const double d2 = way.squaredNorm();
                if (d2 > reach_m * reach_m) continue;
                const auto weight = static_cast<float>(std::exp(-d2 / (2 * spread * spread)));
                Corner& c = corners_[index(x, y, z)];
                c.weight += weight;
                c.distance += weight * static_cast<float>(n.dot(way));
                for (unsigned i = 0; i < 3; ++i) {
                    c.normal[i] += weight * static_cast<float>(n[static_cast<int>(i)]);
                }
            }
        }
    }
}

}  // namespace djpete::texture
