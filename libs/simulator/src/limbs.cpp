#include "limbs.h"

#include <algorithm>
#include <cmath>

namespace djpete::simulator {

namespace {
constexpr float kPi = 3.14159265F;
}

void addLoft(Mesh& mesh, const std::vector<Section>& sections, uint32_t sides, uint32_t finish,
             float v0) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    const std::size_t firstTriangle = mesh.triangles.size();
    const uint32_t patch = mesh.newPatch(), row = sides + 1;
    float v = v0, girth = 0;
    for (const auto& s : sections) girth = std::max(girth, kPi * (s.a.norm() + s.b.norm()));
    for (std::size_t k = 0; k < sections.size(); ++k) {
        const Section& s = sections[k];
        if (k > 0) v += (s.centre - sections[k - 1].centre).norm();
        for (uint32_t i = 0; i <= sides; ++i) {  // the seam is opposite to `a`
            const float turn = static_cast<float>(i) / static_cast<float>(sides) - 0.5F;
            const float angle = 2.F * kPi * turn;
            mesh.addVertex(s.centre + std::cos(angle) * s.a + std::sin(angle) * s.b,
                           {turn * girth, v});
        }
    }
    for (std::size_t k = 0; k + 1 < sections.size(); ++k) {
        const uint32_t below = first + static_cast<uint32_t>(k) * row, above = below + row;
        for (uint32_t i = 0; i < sides; ++i) {
            if (sections[k].a.norm() > 0)
                mesh.addTriangle(below + i, below + i + 1, above + i + 1, finish, patch);
            if (sections[k + 1].a.norm() > 0)
                mesh.addTriangle(below + i, above + i + 1, above + i, finish, patch);
        }
    }
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
    for (std::size_t t = firstTriangle; t < mesh.triangles.size(); ++t) {
        const auto& q = mesh.triangles[t].vertex;
        const Vec3f& a = mesh.vertices[q[0]];
        const Vec3f n = (mesh.vertices[q[1]] - a).cross(mesh.vertices[q[2]] - a);
        for (uint32_t i : q) mesh.normals[i] += n;
    }
    for (std::size_t k = 0; k < sections.size(); ++k) {
        const uint32_t from = first + static_cast<uint32_t>(k) * row, to = from + sides;
        Vec3f sum = mesh.normals[from] + mesh.normals[to];
        if (sections[k].a.norm() == 0) {  // a pole
            for (uint32_t i = from + 1; i < to; ++i) sum += mesh.normals[i];
            for (uint32_t i = from; i <= to; ++i) mesh.normals[i] = sum;
        }
        mesh.normals[from] = mesh.normals[to] = sum;
        for (uint32_t i = from; i <= to; ++i) mesh.normals[i].normalize();
    }
}

void addCapsule(Mesh& mesh, const Vec3f& from, const Vec3f& to, float radiusFrom, float radiusTo,
                const Vec3f& front, uint32_t sides, uint32_t finish) {
    const Vec3f axis = (to - from).normalized();
    Vec3f a = front - front.dot(axis) * axis;
    a = a.norm() > 1e-3F ? a.normalized() : axis.unitOrthogonal();
    const Vec3f b = axis.cross(a);
    std::vector<Section> sections;
    const auto add = [&](const Vec3f& centre, float r) {
        sections.push_back({centre, r * a, r * b});
    };
    add(from - radiusFrom * axis, 0);
    add(from - 0.7F * radiusFrom * axis, 0.714F * radiusFrom);
    add(from, radiusFrom);
    add(to, radiusTo);
    add(to + 0.7F * radiusTo * axis, 0.714F * radiusTo);
    add(to + radiusTo * axis, 0);
    addLoft(mesh, sections, sides, finish);
}

Vec3f middleJoint(const Vec3f& from, const Vec3f& to, float first, float second,
                  const Vec3f& towards) {
    const Vec3f d = to - from;
    const float length = std::clamp(d.norm(), 1e-3F, 0.999F * (first + second));
    const Vec3f axis = d.normalized();
    const float along = (first * first - second * second + length * length) / (2.F * length);
    const float off = std::sqrt(std::max(0.F, first * first - along * along));
    return from + along * axis + off * (towards - towards.dot(axis) * axis).normalized();
}

}  // namespace djpete::simulator
