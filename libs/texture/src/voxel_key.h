/// Integer cells of a grid, packed so that they sort.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "djpete/geometry/types.h"

namespace djpete::texture {

/// Key of the cube of side `voxel_m` that holds p: 21 bits per axis, cell 0 in the middle.
/// Nothing if p is not finite or more than a million cells away.
inline std::optional<uint64_t> voxelKey(const geometry::Vec3& p, double voxel_m) {
    constexpr double kHalf = 1 << 20;
    uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
        const double cell = std::floor(p[i] / voxel_m) + kHalf;
        if (!(cell >= 0 && cell < 2 * kHalf)) return std::nullopt;
        key = (key << 21U) | static_cast<uint64_t>(cell);
    }
    return key;
}

}  // namespace djpete::texture
