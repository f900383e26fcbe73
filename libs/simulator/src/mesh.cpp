#include "mesh.h"

#include <cmath>

#include "noise.h"

namespace djpete::simulator {

uint32_t Mesh::addVertex(const Vec3f& p, const Vec2f& t) {
    vertices.push_back(p);
    uv.push_back(t);
    return static_cast<uint32_t>(vertices.size() - 1);
}

void Mesh::addTriangle(uint32_t a, uint32_t b, uint32_t c, Material material, uint32_t seed) {
    triangles.push_back({{a, b, c}, material, seed});
}

void Mesh::addQuad(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d,
                   Material material, uint32_t seed, const Vec2f& uv0) {
    const float w = (b - a).norm(), h = (d - a).norm();
    const uint32_t i = addVertex(a, uv0);
    addVertex(b, uv0 + Vec2f(w, 0));
    addVertex(c, uv0 + Vec2f(w, h));
    addVertex(d, uv0 + Vec2f(0, h));
    addTriangle(i, i + 1, i + 2, material, seed);
    addTriangle(i, i + 2, i + 3, material, seed);
}

void Mesh::addBox(const Vec3f& base, const Vec3f& size, float yaw_rad, Material material,
                  uint32_t seed) {
    const Vec3f x = 0.5F * size.x() * Vec3f(std::cos(yaw_rad), std::sin(yaw_rad), 0);
    const Vec3f y = 0.5F * size.y() * Vec3f(-std::sin(yaw_rad), std::cos(yaw_rad), 0);
    const Vec3f z(0, 0, size.z());
    const Vec3f a = base - x - y, b = base + x - y, c = base + x + y, d = base - x + y;
    addQuad(a, b, b + z, a + z, material, seed);
    addQuad(b, c, c + z, b + z, material, seed, {17, 0});
    addQuad(c, d, d + z, c + z, material, seed, {37, 0});
    addQuad(d, a, a + z, d + z, material, seed, {59, 0});
    addQuad(a + z, b + z, c + z, d + z, material == Material::Facade ? Material::Roof : material,
            seed);
}

void Mesh::addCylinder(const Vec3f& centre, float radius, float height, bool lying,
                       Material material, uint32_t seed) {
    constexpr uint32_t kSides = 16;
    const Vec3f axis = lying ? Vec3f(0, 1, 0) : Vec3f(0, 0, 1);
    const Vec3f e1(1, 0, 0), e2 = lying ? Vec3f(0, 0, 1) : Vec3f(0, 1, 0);
    const auto first = static_cast<uint32_t>(vertices.size());
    for (uint32_t i = 0; i <= kSides; ++i) {
        const float a = 2.F * static_cast<float>(M_PI) * static_cast<float>(i) / kSides;
        const Vec3f r = radius * (std::cos(a) * e1 + std::sin(a) * e2);
        addVertex(centre + r - 0.5F * height * axis, {a * radius, 0});
        addVertex(centre + r + 0.5F * height * axis, {a * radius, height});
    }
    const uint32_t low = addVertex(centre - 0.5F * height * axis, {0, 0});
    const uint32_t high = addVertex(centre + 0.5F * height * axis, {0, 0});
    for (uint32_t i = 0; i < kSides; ++i) {
        const uint32_t a = first + 2 * i, b = a + 2;
        addTriangle(a, b, b + 1, material, seed);
        addTriangle(a, b + 1, a + 1, material, seed);
        addTriangle(low, b, a, material, seed);
        addTriangle(high, a + 1, b + 1, material, seed);
    }
}

void Mesh::addBlob(const Vec3f& centre, float radius, Material material, uint32_t seed) {
    constexpr uint32_t kRings = 10, kSectors = 16;
    const auto first = static_cast<uint32_t>(vertices.size());
    for (uint32_t r = 0; r <= kRings; ++r) {
        const float theta = static_cast<float>(M_PI) * static_cast<float>(r) / kRings;
        for (uint32_t s = 0; s <= kSectors; ++s) {
            const float phi = 2.F * static_cast<float>(M_PI) * static_cast<float>(s) / kSectors;
            const bool pole = r == 0 || r == kRings;
            const float bump = between(hash(seed, pole ? r : r * 97 + s % kSectors), 0.72F, 1.12F);
            const Vec3f d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                          std::cos(theta));
            addVertex(centre + bump * radius * d, {radius * phi * 1.5F, radius * theta * 1.5F});
        }
    }
    for (uint32_t r = 0; r < kRings; ++r) {
        for (uint32_t s = 0; s < kSectors; ++s) {
            const uint32_t a = first + r * (kSectors + 1) + s, b = a + kSectors + 1;
            addTriangle(a, b, b + 1, material, seed);
            addTriangle(a, b + 1, a + 1, material, seed);
        }
    }
}

void Mesh::smoothNormals() {
    normals.assign(vertices.size(), Vec3f::Zero());
    for (const auto& t : triangles) {
        const Vec3f& a = vertices[t.vertex[0]];
        const Vec3f n = (vertices[t.vertex[1]] - a).cross(vertices[t.vertex[2]] - a);
        for (uint32_t i : t.vertex) normals[i] += n;
    }
    for (auto& n : normals) {
        if (n.norm() > 1e-12F) n.normalize();
    }
}

}  // namespace djpete::simulator
