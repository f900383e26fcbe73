/// Triangles with what shading needs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/geometry/types.h"

namespace djpete::simulator {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;

enum class Material : uint8_t {
    Asphalt,
    Pavement,
    Kerb,
    Grass,
    Brick,
    Plaster,
    Stone,
    Roof,
    Frame,  ///< of windows and doors; sills, gutters
    Glass,
    Wood,
    Trunk,
    Leaf,
    Metal,
    Sign,
    CarBody,  ///< paint, windows, lights, plates: by position on the car
    Tyre,
    Cargo,  ///< body of a truck: panels with a company's letters
    Cloth,  ///< clothes and bags, with stripes and prints
    Skin,
    Hair,
    Shoe,
    BikeFrame,
    BikeWheel  ///< tyre, rim and spokes, by position
};

/// What a face is made of: a textured material, a colour it is multiplied with, and the seed of the
/// thing it belongs to, for its patterns.
struct Finish {
    Material material = Material::Grass;
    Vec3f tint = Vec3f::Ones();
    uint32_t seed = 0;
};

struct Triangle {
    std::array<uint32_t, 3> vertex{};
    uint32_t finish = 0;  ///< index into Mesh::finishes
    uint32_t patch = 0;   ///< one smooth surface; where it changes there is an edge in the image
    Vec3f tangentU = Vec3f::UnitX(), tangentV = Vec3f::UnitY();  ///< unit directions of uv
};

/// Coordinates `uv` are metres on the surface.
struct Mesh {
    std::vector<Vec3f> vertices;
    std::vector<Vec2f> uv;
    std::vector<Vec3f> normals;  ///< per vertex, zero: flat; may be shorter than vertices
    std::vector<Finish> finishes;
    std::vector<Triangle> triangles;
    uint32_t patches = 0;

    uint32_t addFinish(Material material, const Vec3f& tint, uint32_t seed);
    uint32_t newPatch() { return patches++; }
    uint32_t addVertex(const Vec3f& p, const Vec2f& t);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c, uint32_t finish, uint32_t patch);
    /// Corners in order around the quad; u runs along the first edge from `uv0`, v along the
    /// last one's.
    void addQuad(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, uint32_t finish,
                 uint32_t patch, const Vec2f& uv0 = Vec2f::Zero());
    /// Box standing on `base` (centre of its bottom) with horizontal axis x; no bottom face.
    void addBox(const Vec3f& base, const Vec3f& size, const Vec3f& axisX, uint32_t finish);
    /// Round rod between two points; closed with discs if `closed`.
    void addRod(const Vec3f& from, const Vec3f& to, float radiusFrom, float radiusTo,
                uint32_t sides, bool closed, uint32_t finish);
    /// Normals of all vertices so far as means of the adjoining triangles'.
    void smoothNormals();
};

}  // namespace djpete::simulator
