/// Signed distance to an object's surface on a dense grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/texture/object_model.h"
#include "djpete/texture/surface.h"

namespace djpete::texture {

/// Each corner knows the mean of the distances to the planes of the points around it, weighted by
/// nearness, and of their normals.
class DistanceGrid {
  public:
    struct Corner {
        float weight = 0;                      ///< 0: no point is near, nothing is known
        float distance = 0;                    ///< positive outside, metres
        std::array<float, 3> normal{0, 0, 0};  ///< not of unit length
    };

    DistanceGrid(const ObjectModel& model, const MeshOptions& options);

    std::array<int, 3> corners() const { return size_; }
    double voxel_m() const { return voxel_m_; }
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_[0]) +
               static_cast<std::size_t>(x);
    }
    const Corner& at(std::size_t i) const { return corners_[i]; }
    Corner& at(std::size_t i) { return corners_[i]; }
    geometry::Vec3 position(double x, double y, double z) const {
        return low_obj_ + voxel_m_ * geometry::Vec3(x, y, z);
    }

  private:
    void place(const ObjectModel& model, const MeshOptions& options);
    void splat(const geometry::Vec3& p, const geometry::Vec3& n, double radius_m, double reach_m);

    double voxel_m_;
    geometry::Vec3 low_obj_{0, 0, 0};
    std::array<int, 3> size_{0, 0, 0};
    std::vector<Corner> corners_;
};

}  // namespace djpete::texture
