/// Facets of the zero set of a DistanceGrid.
#pragma once

#include <vector>

#include "distance_grid.h"

namespace djpete::texture {

struct Facets {
    struct Vertex {
        geometry::Vec3 p_obj;
        geometry::Vec3 normal;  ///< outward, unit length
    };
    std::vector<Vertex> vertices;
    std::vector<std::array<uint32_t, 4>> quads;  ///< counter-clockwise seen from outside

    /// Keeps vertices whose `keep` is true and quads of four kept vertices.
    void keepOnly(const std::vector<bool>& keep);
    /// Leaves out connected pieces of fewer quads or of fewer different points, and vertices of no
    /// quad. `pointOf` names the point that each vertex stands for, kNoPoint for none. A quarter of
    /// the points of the piece that has most is always enough.
    void dropSmallPieces(std::size_t minQuads, std::size_t minPoints,
                         const std::vector<uint32_t>& pointOf);
    static constexpr uint32_t kNoPoint = 0xFFFFFFFF;
};

/// Surface nets: a vertex in every cell that the surface crosses, at the mean of its crossings of
/// the cell's edges; a quad around every edge that it crosses (Gibson 1998).
Facets surfaceNets(const DistanceGrid& grid);

}  // namespace djpete::texture
