/// Which cells one scan hits and which its rays go through.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "brick_grid.h"
#include "djpete/background/options.h"
#include "scan_record.h"

namespace djpete::background {

/// A box of an object, already grown; nothing in it is hit or carved.
struct KeepOut {
    geometry::SE3 T_world_box;
    geometry::Vec3 half_m{0, 0, 0};
    bool contains(const geometry::Vec3& p_world) const {
        const geometry::Vec3 apart = p_world - T_world_box.translation();
        if (apart.squaredNorm() > half_m.squaredNorm()) return false;
        return ((T_world_box.rotation().transpose() * apart).cwiseAbs() - half_m).maxCoeff() <= 0;
    }
};

/// The object's box without the road below options.ground_clearance_m, grown elsewhere.
KeepOut keepOutOf(const geometry::SE3& T_world_obj, const geometry::Vec3& size_m,
                  const OctoOptions& options);

/// Calls `visit(cell)` for every cell whose centre lies in the box, x, y, z in order.
template <class Visit>
void forCellsIn(const KeepOut& box, double resolution_m, Visit visit);

/// Cells of the world are counted so that the one at the world's origin is (32768, 32768, 32768).
constexpr int kMiddleCell = 32768;
inline geometry::Vec3 centreOf(const Cell& c, double resolution_m) {
    return {(c[0] - kMiddleCell + 0.5) * resolution_m, (c[1] - kMiddleCell + 0.5) * resolution_m,
            (c[2] - kMiddleCell + 0.5) * resolution_m};
}

struct ColouredCell {
    Cell cell{};
    std::array<uint8_t, 3> rgb{};
};

struct RayMarks {
    BrickGrid hits, free;
    std::vector<ColouredCell> colours;
};

/// What `record` says with its vehicle at `T_world_vehicle`. Nothing if a part of it is outside
/// the octree's reach (32768 voxels from the world's origin).
std::optional<RayMarks> markRays(const ScanRecord& record, const geometry::SE3& T_world_vehicle,
                                 const std::vector<KeepOut>& boxes, const OctoOptions& options);

template <class Visit>
void forCellsIn(const KeepOut& box, double resolution_m, Visit visit) {
    const geometry::Vec3 reach =
        box.T_world_box.rotation().cwiseAbs() * box.half_m + geometry::Vec3::Constant(resolution_m);
    const geometry::Vec3& middle = box.T_world_box.translation();
    Cell low{}, high{};
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        low[k] = kMiddleCell + static_cast<int>(std::floor((middle[i] - reach[i]) / resolution_m));
        high[k] = kMiddleCell + static_cast<int>(std::floor((middle[i] + reach[i]) / resolution_m));
    }
    for (Cell c{low[0], 0, 0}; c[0] <= high[0]; ++c[0]) {
        for (c[1] = low[1]; c[1] <= high[1]; ++c[1]) {
            for (c[2] = low[2]; c[2] <= high[2]; ++c[2]) {
                if (box.contains(centreOf(c, resolution_m))) visit(c);
            }
        }
    }
}

}  // namespace djpete::background
