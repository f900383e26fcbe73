/// An object model that takes new points and keeps their normals.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// A point on an object's surface and where it was seen from.
struct SurfacePoint {
    geometry::Vec3 p_obj{0, 0, 0};
    geometry::Vec3 towardsSensor_obj{0, 0, 1};  ///< unit vector
    uint32_t source = 0;                        ///< of whoever gave the point; carried along
};

class GrowingModel {
  public:
    /// `model` must be new and outlive this.
    GrowingModel(ObjectModel& model, double voxel_m);

    /// Adds the points whose voxel is still free (the first of equal voxels wins), at most up to
    /// `maxPoints` points in all, then renews normals and radii where needed. Returns how many.
    std::size_t insert(const std::vector<SurfacePoint>& points, std::size_t maxPoints);
    /// All points as they were inserted, in their order.
    std::vector<SurfacePoint> points() const;
    /// Starts again with other points (the first of equal voxels wins); colours are gone.
    void replace(const std::vector<SurfacePoint>& points);

    /// Lets memory go that only further points need.
    void shrink();

    ObjectModel& model() { return *model_; }
    const ObjectModel& model() const { return *model_; }

  private:
    struct Cell {
        uint64_t key;
        uint32_t index;
    };
    const Cell* find(uint64_t key) const;
    void renewNormals();
    void renewNormal(std::size_t index);

    ObjectModel* model_;
    double voxel_m_;
    std::vector<Cell> cells_;                      ///< sorted by key
    std::vector<std::array<int8_t, 3>> seenFrom_;  ///< unit vectors times 127
    std::vector<uint32_t> sources_;
    std::size_t normalsKnown_ = 0;   ///< points [0, this) have a normal
    std::size_t sizeAtRenewal_ = 0;  ///< when all normals were last computed
};

}  // namespace djpete::texture
