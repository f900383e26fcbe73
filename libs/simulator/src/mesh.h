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
    Facade,
    Roof,
    Trunk,
    Foliage,
    Metal,
    CarBody,  ///< paint, windows, lights, plates: by position on the car
    Tyre
};

struct Triangle {
    std::array<uint32_t, 3> vertex{};
    Material material = Material::Grass;
    uint32_t seed = 0;  ///< of the thing it belongs to: its colours and patterns
};

/// Coordinates `uv` are metres on the surface.
struct Mesh {
    std::vector<Vec3f> vertices;
    std::vector<Vec2f> uv;
    std::vector<Vec3f> normals;  ///< per vertex; empty: flat
    std::vector<Triangle> triangles;

    uint32_t addVertex(const Vec3f& p, const Vec2f& t);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c, Material material, uint32_t seed);
    /// Corners in order around the quad; u runs along the first edge from `uv0`, v along the
    /// second.
    void addQuad(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, Material material,
                 uint32_t seed, const Vec2f& uv0 = Vec2f::Zero());
    /// Upright box standing on `base` (centre of its bottom), turned by `yaw_rad`.
    void addBox(const Vec3f& base, const Vec3f& size, float yaw_rad, Material material,
                uint32_t seed);
    /// Upright cylinder (or along y if `lying`) of 12 sides around `centre`.
    void addCylinder(const Vec3f& centre, float radius, float height, bool lying, Material material,
                     uint32_t seed);
    /// A ball with a bumpy surface.
    void addBlob(const Vec3f& centre, float radius, Material material, uint32_t seed);
    /// Normals as means of the adjoining triangles'.
    void smoothNormals();
};

}  // namespace djpete::simulator
