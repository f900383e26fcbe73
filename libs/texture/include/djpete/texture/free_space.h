/// Where the sensors looked through an object's box without meeting anything.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/geometry/types.h"

namespace djpete::texture {

/// A coarse grid over an object's box, frame obj, that remembers the rays that passed. A point that
/// was never measured but lies where rays passed cannot be surface. Plain data, so that it can be
/// stored; empty until the first ray.
struct FreeSpace {
    static constexpr float kCell_m = 0.15F;
    static constexpr uint8_t kSureRays = 2;  ///< so many rays make a cell free

    std::array<float, 3> low_m{0, 0, 0};  ///< corner of cell (0, 0, 0)
    std::array<uint16_t, 3> cells{0, 0, 0};
    std::vector<uint8_t> passed;  ///< rays per cell, x fastest, at most 255
    std::vector<uint8_t> hits;    ///< measured points per cell, at most 255

    bool empty() const { return passed.empty(); }
    /// Covers a box of this size around the origin and a cell more; forgets what there was.
    void reset(const geometry::Vec3& size_m);
    /// A ray from a sensor to the point where it ended: cells before the end's own and its
    /// neighbour's are passed, the end's is hit.
    void addRay(const geometry::Vec3& sensor_obj, const geometry::Vec3& end_obj);
    /// True if rays passed p_obj's cell and few ended there; false outside the grid.
    bool isFree(const geometry::Vec3& p_obj) const;
};

}  // namespace djpete::texture
