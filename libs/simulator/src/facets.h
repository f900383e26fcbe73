/// What shading needs of a mesh, gathered per triangle: one place in memory per ray instead of a
/// dozen.
#pragma once

#include <vector>

#include "mesh.h"

namespace djpete::simulator {

struct alignas(64) Facet {
    Vec2f uv, uvAlongB, uvAlongC;  ///< uv at the first corner; change towards the others
    Vec3f normal;                  ///< of the plane, unit length
    Vec3f tangentU, tangentV;
    Vec3f normalA, normalAlongB, normalAlongC;  ///< smooth normal likewise; zero: flat
    Finish finish;
    uint32_t patch = 0;
};

/// One per triangle. The mesh's `normals` may be shorter than its vertices: flat there.
std::vector<Facet> facetsOf(const Mesh& mesh);

}  // namespace djpete::simulator
