#include "street_builder.h"

#include <cmath>

#include "building.h"
#include "foliage.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

constexpr float kKerb_m = 0.12F;
constexpr double kPavement_m = 2.6;
constexpr std::size_t kTrees = 6, kHedges = 3;

Vec3f at(const Street& street, double s, double lateral, float z) {
    const geometry::Vec3 p = street.poseAt(s, lateral).translation();
    return Vec3f(static_cast<float>(p.x()), static_cast<float>(p.y()), z);
}
Vec3f along(const Street& street, double s) {
    return street.poseAt(s).rotation().col(0).cast<float>();
}

/// A strip between two lateral offsets with uv = (s, lateral).
void addStrip(Mesh& mesh, const Street& street, double from, double to, float zFrom, float zTo,
              uint32_t finish) {
    constexpr double kStep = 2.0;
    const auto n = static_cast<int>(street.length_m() / kStep);
    const uint32_t patch = mesh.newPatch();
    uint32_t previous = 0;
    for (int i = 0; i <= n; ++i) {
        const double s = i * kStep;
        const auto u = static_cast<float>(s);
        const uint32_t a =
            mesh.addVertex(at(street, s, from, zFrom), {u, static_cast<float>(from)});
        mesh.addVertex(at(street, s, to, zTo), {u, static_cast<float>(to) + (zTo - zFrom)});
        if (i > 0) {
            mesh.addTriangle(previous, a, a + 1, finish, patch);
            mesh.addTriangle(previous, a + 1, previous + 1, finish, patch);
        }
        previous = a;
    }
}

void addGround(Mesh& mesh, const Street& street, uint32_t seed) {
    const double r = kRoadHalfWidth_m, w = 0.14;
    const uint32_t asphalt = mesh.addFinish(Material::Asphalt, Vec3f(0.165F, 0.163F, 0.158F), seed);
    const uint32_t kerb = mesh.addFinish(Material::Kerb, Vec3f(0.34F, 0.33F, 0.31F), seed);
    const uint32_t slabs = mesh.addFinish(Material::Pavement, Vec3f(0.33F, 0.31F, 0.28F), seed);
    const uint32_t lawn = mesh.addFinish(Material::Grass, Vec3f(0.115F, 0.16F, 0.055F), seed);
    addStrip(mesh, street, -r, r, 0, 0, asphalt);
    for (double side : {-1.0, 1.0}) {
        addStrip(mesh, street, side * r, side * r, 0, kKerb_m, kerb);
        addStrip(mesh, street, side * r, side * (r + w), kKerb_m, kKerb_m, kerb);
        addStrip(mesh, street, side * (r + w), side * (r + kPavement_m), kKerb_m, kKerb_m, slabs);
        addStrip(mesh, street, side * (r + kPavement_m), side * (r + 26), kKerb_m, kKerb_m, lawn);
    }
    const float far = static_cast<float>(street.length_m()) + 400.F;
    mesh.addQuad({-400, -far, -0.05F}, {far, -far, -0.05F}, {far, far, -0.05F}, {-400, far, -0.05F},
                 lawn, mesh.newPatch());
}

void addHedgeRow(StreetModel& model, const Street& street, double from, double to, double lateral,
                 uint32_t id) {
    const auto count = static_cast<int>((to - from) / 2.0);
    for (int i = 0; i < count; ++i) {
        const double s = from + 2.0 * i + 1.0;
        const auto k = static_cast<std::size_t>(hash(id, static_cast<uint32_t>(i)) % kHedges);
        model.plants.push_back({kTrees + k, at(street, s, lateral, kKerb_m),
                                static_cast<float>(street.poseAt(s).yaw_rad()),
                                between(id, 0.85F, 1.1F)});
    }
}

void addTree(StreetModel& model, const Street& street, double s, double lateral, uint32_t id) {
    model.plants.push_back({hash(id, 1U) % kTrees, at(street, s, lateral, 0.F),
                            between(hash(id, 2U), 0.F, 6.28F), between(hash(id, 3U), 0.85F, 1.3F)});
}

/// A house whose front runs along the street, or a garden with a hedge and trees.
void addPlot(StreetModel& model, const Street& street, double s, double width, double side,
             uint32_t id) {
    const double mid = s + 0.5 * width, fence = kRoadHalfWidth_m + kPavement_m + 0.45;
    const double setback =
        unit(hash(id, 13U)) < 0.45F ? 0.1 : static_cast<double>(between(hash(id, 2U), 2.2F, 4.5F));
    if (unit(hash(id, 1U)) < 0.16F) {
        addHedgeRow(model, street, s, s + width, side * fence, id);
        for (uint32_t k = 0; k < 3; ++k)
            addTree(model, street, s + width * (0.2 + 0.3 * k), side * (fence + 3.0 + 2.0 * k),
                    hash(id, k));
        return;
    }
    Plot plot;
    plot.width_m = static_cast<float>(width) -
                   (unit(hash(id, 5U)) < 0.55F ? 0.05F : between(hash(id, 6U), 1.F, 4.F));
    plot.depth_m = between(hash(id, 3U), 8.F, 11.F);
    const auto T = street.poseAt(mid);
    plot.y = static_cast<float>(-side) * T.rotation().col(1).cast<float>();
    plot.x = plot.y.cross(Vec3f::UnitZ());
    plot.origin = at(street, mid, side * (kRoadHalfWidth_m + kPavement_m + setback), kKerb_m) -
                  0.5F * plot.width_m * plot.x;
    addHouse(model.mesh, plot, id);
    if (setback < 2) return;
    const float kind = unit(hash(id, 14U));
    if (kind < 0.45F) {
        const uint32_t wall = model.mesh.addFinish(Material::Stone, Vec3f(0.40F, 0.37F, 0.32F), id);
        model.mesh.addBox(at(street, mid, side * fence, kKerb_m),
                          {plot.width_m, 0.25F, between(id, 0.6F, 1.1F)}, along(street, mid), wall);
    } else if (kind < 0.8F) {
        addHedgeRow(model, street, s, s + width - 2.0, side * fence, id);
    }
    if (kind > 0.3F) addTree(model, street, mid + 0.3 * width, side * (fence + 1.3), hash(id, 15U));
}

void addPole(Mesh& mesh, const Street& street, double s, double side, uint32_t id) {
    const Vec3f foot = at(street, s, side * (kRoadHalfWidth_m + 0.5), kKerb_m);
    const Vec3f inward =
        static_cast<float>(-side) * street.poseAt(s).rotation().col(1).cast<float>();
    const uint32_t metal = mesh.addFinish(Material::Metal, Vec3f(0.30F, 0.31F, 0.31F), id);
    if (unit(hash(id, 9U)) < 0.5F) {  // lamp
        const Vec3f top = foot + Vec3f(0, 0, 6.5F);
        mesh.addRod(foot, top, 0.075F, 0.05F, 10, false, metal);
        mesh.addRod(top, top + 1.3F * inward + Vec3f(0, 0, 0.25F), 0.04F, 0.035F, 8, false, metal);
        mesh.addBox(top + 1.4F * inward + Vec3f(0, 0, 0.18F), {0.7F, 0.25F, 0.12F}, inward, metal);
        return;
    }
    static const std::array<Vec3f, 4> kSigns{Vec3f(0.03F, 0.10F, 0.45F), Vec3f(0.55F, 0.04F, 0.04F),
                                             Vec3f(0.70F, 0.68F, 0.62F),
                                             Vec3f(0.65F, 0.45F, 0.03F)};
    mesh.addRod(foot, foot + Vec3f(0, 0, 2.9F), 0.035F, 0.035F, 8, false, metal);
    const uint32_t face = mesh.addFinish(Material::Sign, kSigns[hash(id, 3U) % 4], id);
    const float tall = unit(hash(id, 4U)) < 0.5F ? 0.6F : 0.85F;
    const Vec3f u = 0.3F * inward,
                low = foot + Vec3f(0, 0, 2.85F - tall) - 0.045F * along(street, s);
    mesh.addQuad(low - u, low + u, low + u + Vec3f(0, 0, tall), low - u + Vec3f(0, 0, tall), face,
                 mesh.newPatch());
}

}  // namespace

StreetModel buildStreet(const Street& street, uint32_t seed) {
    StreetModel model;
    for (uint32_t k = 0; k < kTrees; ++k) model.prototypes.push_back(makeTree(hash(seed, 500U, k)));
    for (uint32_t k = 0; k < kHedges; ++k)
        model.prototypes.push_back(makeHedge(hash(seed, 510U, k)));
    addGround(model.mesh, street, seed);
    for (uint32_t sideIndex = 0; sideIndex < 2; ++sideIndex) {
        const double side = sideIndex == 0 ? -1.0 : 1.0;
        uint32_t n = 0;
        for (double s = 2; s < street.length_m() - 16;) {
            const uint32_t id = hash(seed, 100U + sideIndex, n++);
            const double width = static_cast<double>(between(hash(id, 10U), 8.F, 15.F));
            addPlot(model, street, s, width, side, id);
            s += width;
        }
        n = 0;
        for (double s = 4; s < street.length_m() - 4;) {
            const uint32_t id = hash(seed, 200U + sideIndex, n++);
            if (unit(hash(id, 11U)) < 0.66F)
                addTree(model, street, s, side * (kRoadHalfWidth_m + 0.7), id);
            else
                addPole(model.mesh, street, s, side, id);
            s += static_cast<double>(between(hash(id, 12U), 8.F, 19.F));
        }
    }
    model.mesh.normals.resize(model.mesh.vertices.size(), Vec3f::Zero());
    return model;
}

}  // namespace djpete::simulator
