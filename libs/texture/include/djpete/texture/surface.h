/// A triangle mesh of an object.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// A picture that covers the triangles of a mesh: a small square for each two of them.
struct MeshAtlas {
    uint32_t width_px = 0, height_px = 0;
    std::vector<std::array<uint8_t, 3>> rgb;  ///< row-major, top row first
    /// Per triangle and corner (u, v) in 0..1 from the picture's upper left corner.
    std::vector<std::array<std::array<float, 2>, 3>> corners;

    bool empty() const { return rgb.empty(); }
};

struct ColouredMesh {
    struct Vertex {
        std::array<float, 3> position{0, 0, 0};  ///< frame obj, metres
        std::array<float, 3> normal{0, 0, 1};    ///< outward, frame obj
        std::array<uint8_t, 3> rgb{0, 0, 0};
    };
    std::vector<Vertex> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
    MeshAtlas atlas;                                 ///< empty: colours of vertices only
};

struct MeshOptions {
    double voxel_m = 0.04;              ///< edge of the cells; larger for very large objects
    double support_radii = 3;           ///< a point shapes the surface so many of its radii around
    double trim_radii = 2;              ///< surface farther than this from all points is cut off
    uint64_t min_piece_triangles = 60;  ///< smaller loose pieces are left out
    uint64_t min_piece_points = 15;     ///< so are pieces of fewer points (of sparse ones: fewer)
    bool close = false;                 ///< a closed body; see makeMesh
    uint32_t block_px = 4;              ///< side of two triangles' square in the atlas; 0: no atlas
};

/// The surface that the points and their normals describe (the zero set of their weighted planes,
/// by surface nets), with the colours of the nearest points; points without a colour are
/// kNeutralGrey. With `close`, the surface goes on where no point is: smoothly from what is known
/// to the silhouette that the points have from the side, as wide as the box, but not where rays
/// passed; nothing is trimmed then, and every edge has two triangles or four. Triangles 2k and 2k +
/// 1 are one four-sided facet. Empty for an empty model.
ColouredMesh makeMesh(const ObjectModel& model, const MeshOptions& options = MeshOptions());

}  // namespace djpete::texture
