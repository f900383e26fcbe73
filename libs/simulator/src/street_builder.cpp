#include "street_builder.h"

#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

constexpr float kKerb_m = 0.12F;

Vec3f at(const Street& street, double s, double lateral, float z) {
    const geometry::Vec3 p = street.poseAt(s, lateral).translation();
    return Vec3f(static_cast<float>(p.x()), static_cast<float>(p.y()), z);
}

/// A strip between two lateral offsets with uv = (s, lateral).
void addStrip(Mesh& mesh, const Street& street, double from, double to, float zFrom, float zTo,
              Material material, uint32_t seed) {
    constexpr double kStep = 2.0;
    const auto n = static_cast<int>(street.length_m() / kStep);
    uint32_t previous = 0;
    for (int i = 0; i <= n; ++i) {
        const double s = i * kStep;
        const auto u = static_cast<float>(s);
        const uint32_t a =
            mesh.addVertex(at(street, s, from, zFrom), {u, static_cast<float>(from)});
        mesh.addVertex(at(street, s, to, zTo), {u, static_cast<float>(to) + (zTo - zFrom)});
        if (i > 0) {
            mesh.addTriangle(previous, a, a + 1, material, seed);
            mesh.addTriangle(previous, a + 1, previous + 1, material, seed);
        }
        previous = a;
    }
}

void addGround(Mesh& mesh, const Street& street, uint32_t seed) {
    const double r = kRoadHalfWidth_m;
    addStrip(mesh, street, -r, r, 0, 0, Material::Asphalt, seed);
    for (double side : {-1.0, 1.0}) {
        addStrip(mesh, street, side * r, side * r, 0, kKerb_m, Material::Kerb, seed);
        addStrip(mesh, street, side * r, side * (r + 3.2), kKerb_m, kKerb_m, Material::Pavement,
                 seed);
    }
    const float far = static_cast<float>(street.length_m()) + 400.F;
    mesh.addQuad({-400, -far, -0.05F}, {far, -far, -0.05F}, {far, far, -0.05F}, {-400, far, -0.05F},
                 Material::Grass, seed);
}

/// A house whose front runs along the street, or a gap with a hedge before it.
void addPlot(Mesh& mesh, const Street& street, double s, double width, double side, uint32_t id) {
    const double mid = s + 0.5 * width;
    const bool house = unit(hash(id, 1U)) < 0.84F;
    const double front = kRoadHalfWidth_m + between(hash(id, 2U), 3.3F, 5.4F);
    if (house) {
        const float depth = between(hash(id, 3U), 8.F, 12.F),
                    height = between(hash(id, 4U), 6.5F, 13.F);
        const auto T = street.poseAt(mid, side * (front + 0.5 * static_cast<double>(depth)));
        const geometry::Vec3& p = T.translation();
        const Vec3f base(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.F);
        const auto yaw = static_cast<float>(T.yaw_rad());
        const float w = static_cast<float>(width) - between(hash(id, 5U), 0.F, 1.2F);
        mesh.addBox(base, {w, depth, height}, yaw, Material::Facade, id);
        mesh.addBox(base + Vec3f(0, 0, height), {w + 0.5F, depth + 0.6F, 0.25F}, yaw,
                    Material::Roof, id);
    } else {
        const auto T = street.poseAt(mid, side * (kRoadHalfWidth_m + 3.6));
        const geometry::Vec3& p = T.translation();
        const Vec3f base(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.F);
        mesh.addBox(base,
                    {static_cast<float>(width) - 0.6F, 0.7F, between(hash(id, 6U), 1.1F, 1.9F)},
                    static_cast<float>(T.yaw_rad()), Material::Foliage, id);
        for (uint32_t k = 0; k < 3; ++k) {
            const double ds = width * static_cast<double>(k + 1) / 4.0;
            const float r = between(hash(id, 40U, k), 1.4F, 2.4F);
            mesh.addBlob(at(street, s + ds, side * (kRoadHalfWidth_m + 7.0), r * 1.6F), r,
                         Material::Foliage, hash(id, k));
        }
    }
}

void addTree(Mesh& mesh, const Street& street, double s, double side, uint32_t id) {
    const Vec3f foot = at(street, s, side * (kRoadHalfWidth_m + 1.0), kKerb_m);
    const float height = between(hash(id, 7U), 2.4F, 3.4F);
    mesh.addCylinder(foot + Vec3f(0, 0, 0.5F * height), between(hash(id, 8U), 0.11F, 0.19F), height,
                     false, Material::Trunk, id);
    for (uint32_t k = 0; k < 5; ++k) {
        const Vec3f offset(between(hash(id, 60U, k), -0.9F, 0.9F),
                           between(hash(id, 61U, k), -0.9F, 0.9F),
                           between(hash(id, 62U, k), 0.0F, 1.5F));
        mesh.addBlob(foot + Vec3f(0, 0, height + 0.4F) + offset,
                     between(hash(id, 63U, k), 0.7F, 1.2F), Material::Foliage, hash(id, 70U, k));
    }
}

void addPole(Mesh& mesh, const Street& street, double s, double side, uint32_t id) {
    const Vec3f foot = at(street, s, side * (kRoadHalfWidth_m + 0.5), kKerb_m);
    mesh.addCylinder(foot + Vec3f(0, 0, 2.6F), 0.06F, 5.2F, false, Material::Metal, id);
    if (unit(hash(id, 9U)) < 0.5F) {
        const auto yaw = static_cast<float>(street.poseAt(s).yaw_rad());
        mesh.addBox(foot + Vec3f(0, 0, 2.2F), {0.05F, 0.6F, 0.6F}, yaw, Material::Metal,
                    hash(id, 3U));
    }
}

}  // namespace

Mesh buildStreet(const Street& street, uint32_t seed) {
    Mesh mesh;
    addGround(mesh, street, seed);
    for (uint32_t sideIndex = 0; sideIndex < 2; ++sideIndex) {
        const double side = sideIndex == 0 ? -1.0 : 1.0;
        uint32_t n = 0;
        for (double s = -20; s < street.length_m();) {
            const uint32_t id = hash(seed, 100U + sideIndex, n++);
            const double width = static_cast<double>(between(hash(id, 10U), 7.F, 15.F));
            addPlot(mesh, street, s, width, side, id);
            s += width;
        }
        n = 0;
        for (double s = 4; s < street.length_m();) {
            const uint32_t id = hash(seed, 200U + sideIndex, n++);
            if (unit(hash(id, 11U)) < 0.62F) {
                addTree(mesh, street, s, side, id);
            } else {
                addPole(mesh, street, s, side, id);
            }
            s += static_cast<double>(between(hash(id, 12U), 7.F, 17.F));
        }
    }
    return mesh;
}

}  // namespace djpete::simulator
