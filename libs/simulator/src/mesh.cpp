#include "mesh.h"

#include <cmath>

namespace djpete::simulator {

uint32_t Mesh::addFinish(Material material, const Vec3f& tint, uint32_t seed) {
    finishes.push_back({material, tint, seed});
    return static_cast<uint32_t>(finishes.size() - 1);
}

uint32_t Mesh::addVertex(const Vec3f& p, const Vec2f& t) {
    vertices.push_back(p);
    uv.push_back(t);
    return static_cast<uint32_t>(vertices.size() - 1);
}

void Mesh::addTriangle(uint32_t a, uint32_t b, uint32_t c, uint32_t finish, uint32_t patch) {
    Triangle t;
    t.vertex = {a, b, c};
    t.finish = finish;
    t.patch = patch;
    // [du1 dv1; du2 dv2] [Tu; Tv] = [e1; e2] gives the directions of u and v.
    const Vec3f e1 = vertices[b] - vertices[a], e2 = vertices[c] - vertices[a];
    const Vec2f d1 = uv[b] - uv[a], d2 = uv[c] - uv[a];
    const float det = d1.x() * d2.y() - d1.y() * d2.x();
    if (std::abs(det) > 1e-10F) {
        t.tangentU = ((d2.y() * e1 - d1.y() * e2) / det).normalized();
        t.tangentV = ((d1.x() * e2 - d2.x() * e1) / det).normalized();
    }
    triangles.push_back(t);
}

void Mesh::addQuad(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, uint32_t finish,
                   uint32_t patch, const Vec2f& uv0) {
    const float w = (b - a).norm(), h = (d - a).norm();
    const uint32_t i = addVertex(a, uv0);
    addVertex(b, uv0 + Vec2f(w, 0));
    addVertex(c, uv0 + Vec2f(w, h));
    addVertex(d, uv0 + Vec2f(0, h));
    addTriangle(i, i + 1, i + 2, finish, patch);
    addTriangle(i, i + 2, i + 3, finish, patch);
}

void Mesh::addBox(const Vec3f& base, const Vec3f& size, const Vec3f& axisX, uint32_t finish) {
    const Vec3f x = 0.5F * size.x() * axisX;
    const Vec3f y = 0.5F * size.y() * Vec3f(-axisX.y(), axisX.x(), 0);
    const Vec3f z(0, 0, size.z());
    const Vec3f a = base - x - y, b = base + x - y, c = base + x + y, d = base - x + y;
    addQuad(a, b, b + z, a + z, finish, newPatch());
    addQuad(b, c, c + z, b + z, finish, newPatch());
    addQuad(c, d, d + z, c + z, finish, newPatch());
    addQuad(d, a, a + z, d + z, finish, newPatch());
    addQuad(a + z, b + z, c + z, d + z, finish, newPatch());
}

void Mesh::addRod(const Vec3f& from, const Vec3f& to, float radiusFrom, float radiusTo,
                  uint32_t sides, bool closed, uint32_t finish) {
    const Vec3f axis = (to - from).normalized();
    const Vec3f e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
    const float length = (to - from).norm();
    const auto first = static_cast<uint32_t>(vertices.size());
    const uint32_t patch = newPatch();
    normals.resize(vertices.size(), Vec3f::Zero());
    for (uint32_t i = 0; i <= sides; ++i) {
        const float a =
            2.F * static_cast<float>(M_PI) * static_cast<float>(i) / static_cast<float>(sides);
        const Vec3f r = std::cos(a) * e1 + std::sin(a) * e2;
        addVertex(from + radiusFrom * r, {a * radiusFrom, 0});
        addVertex(to + radiusTo * r, {a * radiusFrom, length});
        normals.insert(normals.end(), 2, r);
    }
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = first + 2 * i, b = a + 2;
        addTriangle(a, b, b + 1, finish, patch);
        addTriangle(a, b + 1, a + 1, finish, patch);
    }
    if (!closed) return;
    for (int end = 0; end < 2; ++end) {  // own vertices: flat
        const Vec3f& centre = end == 0 ? from : to;
        const uint32_t middle = addVertex(centre, {0, 0});
        const uint32_t disc = newPatch();
        for (uint32_t i = 0; i <= sides; ++i)
            addVertex(vertices[first + 2 * i + static_cast<uint32_t>(end)], {0, 0});
        for (uint32_t i = 0; i < sides; ++i) {  // seen from outside, counter-clockwise
            const uint32_t a = middle + 1 + i, b = a + 1;
            addTriangle(middle, end == 0 ? b : a, end == 0 ? a : b, finish, disc);
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
