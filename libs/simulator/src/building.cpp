#include "building.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

struct Style {
    uint32_t wall = 0, plinth = 0, frame = 0, roof = 0, shutter = 0, sill = 0, metal = 0;
    float floor_m = 2.9F, bay_m = 2.6F, plinth_m = 0.5F;
    float halfWindow_m = 0.5F, window_m = 1.4F, reveal_m = 0.14F;
    int floors = 2;
    bool shutters = false;
};

struct Opening {
    float x0 = 0, z0 = 0, x1 = 0, z1 = 0;
    bool door = false;
};

Vec3f varied(const Vec3f& colour, uint32_t h) {
    return between(h, 0.85F, 1.12F) *
           colour.cwiseProduct(
               Vec3f(between(hash(h, 1U), 0.95F, 1.05F), 1.F, between(hash(h, 2U), 0.92F, 1.06F)));
}

Style makeStyle(Mesh& mesh, uint32_t seed) {
    static const std::array<Vec3f, 8> kPlaster{
        Vec3f(0.82F, 0.80F, 0.74F), Vec3f(0.84F, 0.83F, 0.80F), Vec3f(0.76F, 0.68F, 0.50F),
        Vec3f(0.58F, 0.57F, 0.54F), Vec3f(0.74F, 0.60F, 0.50F), Vec3f(0.68F, 0.69F, 0.60F),
        Vec3f(0.80F, 0.74F, 0.58F), Vec3f(0.78F, 0.77F, 0.74F)};
    static const std::array<Vec3f, 4> kBrick{Vec3f(0.33F, 0.15F, 0.10F), Vec3f(0.38F, 0.22F, 0.14F),
                                             Vec3f(0.30F, 0.18F, 0.13F),
                                             Vec3f(0.44F, 0.33F, 0.20F)};
    static const std::array<Vec3f, 4> kRoof{Vec3f(0.30F, 0.13F, 0.09F), Vec3f(0.22F, 0.13F, 0.10F),
                                            Vec3f(0.15F, 0.15F, 0.16F), Vec3f(0.34F, 0.19F, 0.13F)};
    static const std::array<Vec3f, 5> kShutter{
        Vec3f(0.08F, 0.16F, 0.10F), Vec3f(0.22F, 0.11F, 0.07F), Vec3f(0.10F, 0.14F, 0.22F),
        Vec3f(0.45F, 0.43F, 0.38F), Vec3f(0.28F, 0.08F, 0.07F)};
    Style s;
    const float kind = unit(hash(seed, 1U));
    const Material material =
        kind < 0.82F ? Material::Plaster : (kind < 0.94F ? Material::Brick : Material::Stone);
    const Vec3f colour = material == Material::Plaster ? kPlaster[hash(seed, 2U) % 8]
                         : material == Material::Brick ? kBrick[hash(seed, 2U) % 4]
                                                       : Vec3f(0.42F, 0.38F, 0.32F);
    s.wall = mesh.addFinish(material, varied(colour, hash(seed, 3U)), seed);
    s.plinth = mesh.addFinish(unit(hash(seed, 4U)) < 0.5F ? Material::Stone : Material::Plaster,
                              Vec3f::Constant(between(hash(seed, 5U), 0.20F, 0.34F)), seed);
    const float light = unit(hash(seed, 6U)) < 0.75F ? 0.68F : 0.16F;
    s.frame = mesh.addFinish(Material::Frame, Vec3f::Constant(light), seed);
    s.sill = mesh.addFinish(Material::Frame, Vec3f::Constant(0.42F), seed);
    s.roof =
        mesh.addFinish(Material::Roof, varied(kRoof[hash(seed, 7U) % 4], hash(seed, 8U)), seed);
    s.shutter = mesh.addFinish(Material::Wood, kShutter[hash(seed, 9U) % 5], seed);
    s.metal = mesh.addFinish(Material::Metal, Vec3f(0.26F, 0.25F, 0.24F), seed);
    s.bay_m = between(hash(seed, 10U), 2.2F, 3.2F);
    s.floor_m = between(hash(seed, 11U), 2.75F, 3.2F);
    s.plinth_m = between(hash(seed, 12U), 0.35F, 0.75F);
    s.halfWindow_m = between(hash(seed, 13U), 0.42F, 0.66F);
    s.window_m = between(hash(seed, 14U), 1.25F, 1.65F);
    s.floors = 2 + static_cast<int>(hash(seed, 15U) % 3U) - (unit(hash(seed, 16U)) < 0.3F ? 1 : 0);
    s.shutters = s.bay_m > 2.5F && unit(hash(seed, 17U)) < 0.4F;
    return s;
}

/// Upright rectangle parallel to the front, `out` metres before it.
void addPane(Mesh& mesh, const Plot& plot, float x0, float z0, float x1, float z1, float out,
             uint32_t finish, uint32_t patch) {
    if (x1 - x0 < 1e-4F || z1 - z0 < 1e-4F) return;
    mesh.addQuad(plot.at(x0, out, z0), plot.at(x1, out, z0), plot.at(x1, out, z1),
                 plot.at(x0, out, z1), finish, patch, {x0, z0});
}

void addBar(Mesh& mesh, const Plot& plot, float x0, float z0, float x1, float z1, float back,
            float front, uint32_t finish) {
    mesh.addBox(plot.at(0.5F * (x0 + x1), 0.5F * (back + front), z0),
                {x1 - x0, front - back, z1 - z0}, plot.x, finish);
}

void addReveal(Mesh& mesh, const Plot& plot, const Opening& o, float depth, uint32_t finish) {
    const Vec3f a = plot.at(o.x0, 0, o.z0), b = plot.at(o.x1, 0, o.z0), c = plot.at(o.x1, 0, o.z1),
                d = plot.at(o.x0, 0, o.z1), in = -depth * plot.y;
    mesh.addQuad(a, b, b + in, a + in, finish, mesh.newPatch());
    mesh.addQuad(b, c, c + in, b + in, finish, mesh.newPatch());
    mesh.addQuad(c, d, d + in, c + in, finish, mesh.newPatch());
    mesh.addQuad(d, a, a + in, d + in, finish, mesh.newPatch());
}

void addWindow(Mesh& mesh, const Plot& plot, const Style& s, const Opening& o, uint32_t h) {
    const float back = -s.reveal_m, rim = 0.06F, mid = 0.5F * (o.x0 + o.x1);
    addReveal(mesh, plot, o, s.reveal_m, s.wall);
    const uint32_t glass = mesh.addFinish(Material::Glass, Vec3f::Ones(), h);
    mesh.addQuad(plot.at(o.x0, back, o.z0), plot.at(o.x1, back, o.z0), plot.at(o.x1, back, o.z1),
                 plot.at(o.x0, back, o.z1), glass, mesh.newPatch(), {0, 0});
    const float front = back + 0.04F;
    addBar(mesh, plot, o.x0, o.z0, o.x0 + rim, o.z1, back, front, s.frame);
    addBar(mesh, plot, o.x1 - rim, o.z0, o.x1, o.z1, back, front, s.frame);
    addBar(mesh, plot, o.x0 + rim, o.z0, o.x1 - rim, o.z0 + rim, back, front, s.frame);
    addBar(mesh, plot, o.x0 + rim, o.z1 - rim, o.x1 - rim, o.z1, back, front, s.frame);
    if (o.x1 - o.x0 > 0.95F)
        addBar(mesh, plot, mid - 0.035F, o.z0 + rim, mid + 0.035F, o.z1 - rim, back, front,
               s.frame);
    if (hash(s.wall, s.floors > 2 ? 1U : 0U) % 2U == 0) {
        const float cross = o.z0 + 0.68F * (o.z1 - o.z0);
        addBar(mesh, plot, o.x0 + rim, cross - 0.025F, o.x1 - rim, cross + 0.025F, back, front,
               s.frame);
    }
    addBar(mesh, plot, o.x0 - 0.08F, o.z0 - 0.07F, o.x1 + 0.08F, o.z0, -0.02F, 0.09F, s.sill);
    if (!s.shutters) return;
    const float wing = 0.5F * (o.x1 - o.x0);
    addBar(mesh, plot, o.x0 - wing - 0.02F, o.z0, o.x0 - 0.02F, o.z1, 0, 0.045F, s.shutter);
    addBar(mesh, plot, o.x1 + 0.02F, o.z0, o.x1 + wing + 0.02F, o.z1, 0, 0.045F, s.shutter);
}

void addDoor(Mesh& mesh, const Plot& plot, const Style& s, const Opening& o, uint32_t h) {
    addReveal(mesh, plot, o, 0.2F, s.wall);
    const Vec3f colour(between(h, 0.05F, 0.32F), between(hash(h, 1U), 0.06F, 0.20F),
                       between(hash(h, 2U), 0.05F, 0.16F));
    const uint32_t wood = mesh.addFinish(Material::Wood, colour, h);
    const uint32_t glass = mesh.addFinish(Material::Glass, Vec3f::Ones(), h);
    addPane(mesh, plot, o.x0, o.z0, o.x1, o.z1, -0.2F, wood, mesh.newPatch());
    const float x0 = o.x0 + 0.22F, x1 = o.x1 - 0.22F, z0 = o.z0 + 1.2F, z1 = o.z1 - 0.25F;
    addPane(mesh, plot, x0, z0, x1, z1, -0.19F, glass, mesh.newPatch());
    addBar(mesh, plot, o.x0 - 0.25F, 0, o.x1 + 0.25F, 0.14F, -0.2F, 0.55F, s.sill);  // step
    if (unit(hash(h, 3U)) < 0.5F)
        addBar(mesh, plot, o.x0 - 0.3F, o.z1 + 0.1F, o.x1 + 0.3F, o.z1 + 0.18F, 0, 0.9F, s.metal);
}

/// The wall of one bay and floor around its opening.
void addCell(Mesh& mesh, const Plot& plot, float x0, float z0, float x1, float z1, const Opening& o,
             uint32_t finish, uint32_t patch) {
    addPane(mesh, plot, x0, z0, o.x0, z1, 0, finish, patch);
    addPane(mesh, plot, o.x1, z0, x1, z1, 0, finish, patch);
    addPane(mesh, plot, o.x0, z0, o.x1, o.z0, 0, finish, patch);
    addPane(mesh, plot, o.x0, o.z1, o.x1, z1, 0, finish, patch);
}

void addFront(Mesh& mesh, const Plot& plot, const Style& s, uint32_t seed) {
    const uint32_t wall = mesh.newPatch();
    const int bays = std::max(2, static_cast<int>(plot.width_m / s.bay_m));
    const float bay = plot.width_m / static_cast<float>(bays);
    const auto door = static_cast<int>(hash(seed, 20U) % static_cast<uint32_t>(bays));
    for (int f = 0; f < s.floors; ++f) {
        for (int b = 0; b < bays; ++b) {
            const uint32_t h = hash(seed, 21U, static_cast<uint32_t>(f), static_cast<uint32_t>(b));
            const float x0 = bay * static_cast<float>(b), x1 = x0 + bay, mid = 0.5F * (x0 + x1);
            const float base = s.plinth_m + s.floor_m * static_cast<float>(f);
            const float z0 = f == 0 ? 0.F : base, z1 = base + s.floor_m;
            Opening o{mid - s.halfWindow_m, base + 0.85F, mid + s.halfWindow_m,
                      base + 0.85F + s.window_m, false};
            o.door = f == 0 && b == door;
            if (o.door) o = {mid - 0.5F, 0.12F, mid + 0.5F, 2.2F, true};
            if (!o.door && unit(h) < 0.07F) {
                addPane(mesh, plot, x0, z0, x1, z1, 0, s.wall, wall);
                continue;
            }
            addCell(mesh, plot, x0, z0, x1, z1, o, s.wall, wall);
            if (o.door)
                addDoor(mesh, plot, s, o, h);
            else
                addWindow(mesh, plot, s, o, h);
        }
    }
    const float doorX0 = bay * (static_cast<float>(door) + 0.5F) - 0.5F;
    const uint32_t plinth = mesh.newPatch();
    addPane(mesh, plot, 0, 0, doorX0, s.plinth_m, 0.02F, s.plinth, plinth);
    addPane(mesh, plot, doorX0 + 1.F, 0, plot.width_m, s.plinth_m, 0.02F, s.plinth, plinth);
}

void addSidesAndRoof(Mesh& mesh, const Plot& plot, const Style& s) {
    const float w = plot.width_m, d = plot.depth_m,
                top = s.plinth_m + s.floor_m * static_cast<float>(s.floors);
    const float rise = 0.36F * d, eave = 0.45F, verge = 0.15F;
    for (float x : {0.F, w}) {
        const uint32_t patch = mesh.newPatch();
        mesh.addQuad(plot.at(x, 0, 0), plot.at(x, -d, 0), plot.at(x, -d, top), plot.at(x, 0, top),
                     s.wall, patch);
        const uint32_t a = mesh.addVertex(plot.at(x, 0, top), {0, top});
        mesh.addVertex(plot.at(x, -d, top), {d, top});
        mesh.addVertex(plot.at(x, -0.5F * d, top + rise), {0.5F * d, top + rise});
        mesh.addTriangle(a, a + 1, a + 2, s.wall, patch);
    }
    mesh.addQuad(plot.at(0, -d, 0), plot.at(w, -d, 0), plot.at(w, -d, top), plot.at(0, -d, top),
                 s.wall, mesh.newPatch());
    const float drop = eave * rise / (0.5F * d);
    for (float edge : {eave, -d - eave}) {
        mesh.addQuad(plot.at(-verge, edge, top - drop), plot.at(w + verge, edge, top - drop),
                     plot.at(w + verge, -0.5F * d, top + rise),
                     plot.at(-verge, -0.5F * d, top + rise), s.roof, mesh.newPatch());
    }
    mesh.addRod(plot.at(0, eave + 0.03F, top - drop), plot.at(w, eave + 0.03F, top - drop), 0.07F,
                0.07F, 8, false, s.metal);
    mesh.addRod(plot.at(0.12F, 0.07F, 0), plot.at(0.12F, 0.07F, top), 0.045F, 0.045F, 8, false,
                s.metal);
    const float chimney = 0.3F * w;
    mesh.addBox(plot.at(chimney, -0.45F * d, top + 0.6F * rise), {0.7F, 0.5F, 0.4F * rise + 1.F},
                plot.x, s.plinth);
}

}  // namespace

void addHouse(Mesh& mesh, const Plot& plot, uint32_t seed) {
    const Style style = makeStyle(mesh, seed);
    addFront(mesh, plot, style, seed);
    addSidesAndRoof(mesh, plot, style);
}

}  // namespace djpete::simulator
