#include "foliage.h"

#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

/// A twig of three leaves, each a triangle of length `size`, shaded like the crown's surface it
/// sits on.
void addTwig(Mesh& mesh, const Vec3f& at, const Vec3f& outward, float size, uint32_t finish,
             uint32_t h) {
    const Vec3f jitter(between(hash(h, 1U), -1.F, 1.F), between(hash(h, 2U), -1.F, 1.F),
                       between(hash(h, 3U), -1.F, 1.F));
    const Vec3f n = (0.6F * outward + 0.8F * jitter).normalized();
    const Vec3f x = n.unitOrthogonal(), y = n.cross(x);
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    const uint32_t patch = mesh.newPatch();
    mesh.addVertex(at, {0, 0});
    for (uint32_t leaf = 0; leaf < 3; ++leaf) {
        const float turn = between(hash(h, 4U, leaf), 0.F, 1.2F) + 2.1F * static_cast<float>(leaf);
        const float length = size * between(hash(h, 5U, leaf), 0.75F, 1.15F);
        const float tilt = between(hash(h, 6U, leaf), -0.5F, 0.5F);
        for (float side : {-0.3F, 0.3F}) {
            const Vec2f d(length * std::cos(turn + side), length * std::sin(turn + side));
            mesh.addVertex(at + d.x() * x + d.y() * y + (tilt + 0.4F * side) * length * n, d);
        }
        mesh.addTriangle(first, first + 1 + 2 * leaf, first + 2 + 2 * leaf, finish, patch);
    }
    mesh.normals.insert(mesh.normals.end(), 7, (outward + 0.12F * jitter).normalized());
}

Vec3f onSphere(uint32_t h) {
    const float z = between(hash(h, 11U), -1.F, 1.F), a = between(hash(h, 12U), 0.F, 6.2831853F);
    const float r = std::sqrt(std::max(0.F, 1.F - z * z));
    return {r * std::cos(a), r * std::sin(a), z};
}

/// Greens of one plant, from sunlit to inner leaves.
std::array<uint32_t, 4> leafFinishes(Mesh& mesh, uint32_t seed) {
    const float f = unit(hash(seed, 20U));
    const Vec3f base = (1.F - f) * Vec3f(0.12F, 0.17F, 0.055F) + f * Vec3f(0.17F, 0.19F, 0.08F);
    return {mesh.addFinish(Material::Leaf, base, seed),
            mesh.addFinish(Material::Leaf, 1.07F * base, seed),
            mesh.addFinish(Material::Leaf, 0.93F * base, seed),
            mesh.addFinish(Material::Leaf, 0.78F * base, seed)};
}

/// The dark inside of a crown: a rough ball that stops the eye and most rays.
void addCore(Mesh& mesh, const Vec3f& centre, float radius, uint32_t finish, uint32_t seed) {
    constexpr int kRings = 6, kSpokes = 9;
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    for (int r = 0; r <= kRings; ++r) {
        for (int k = 0; k < kSpokes; ++k) {
            const float polar = 3.1415927F * static_cast<float>(r) / kRings,
                        around = 6.2831853F * static_cast<float>(k) / kSpokes;
            const Vec3f d(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                          std::cos(polar));
            const uint32_t h = hash(seed, static_cast<uint32_t>(r), static_cast<uint32_t>(k));
            mesh.addVertex(centre + radius * between(h, 0.75F, 1.1F) * d, {around, polar});
            mesh.normals.push_back(d);
        }
    }
    const uint32_t patch = mesh.newPatch();
    const auto at = [&](int r, int k) {
        return first + static_cast<uint32_t>(r * kSpokes + k % kSpokes);
    };
    for (int r = 0; r < kRings; ++r) {
        for (int k = 0; k < kSpokes; ++k) {
            mesh.addTriangle(at(r, k), at(r + 1, k), at(r + 1, k + 1), finish, patch);
            mesh.addTriangle(at(r, k), at(r + 1, k + 1), at(r, k + 1), finish, patch);
        }
    }
}

/// One of `kShare` leaves is left of coarse foliage, larger by kGrow.
constexpr uint32_t kShare = 4;
constexpr float kGrow = 1.8F;
uint32_t shareOf(LeafDetail detail) { return detail == LeafDetail::Fine ? 1 : kShare; }
float growthOf(LeafDetail detail) { return detail == LeafDetail::Fine ? 1.F : kGrow; }

/// A bough of leaves.
struct Clump {
    Vec3f centre;
    float radius_m;
};

/// Leaves in the outer shell of a clump; its surface is lumpy, so that light and shade alternate.
void addClump(Mesh& mesh, const Clump& clump, uint32_t twigs, const std::array<uint32_t, 4>& greens,
              uint32_t seed, LeafDetail detail) {
    for (uint32_t i = 0; i < twigs; i += shareOf(detail)) {
        const uint32_t h = hash(seed, 40U, i);
        const Vec3f d = onSphere(h);
        const float depth = std::sqrt(unit(hash(h, 2U)));  // denser outside
        const float bump =
            0.78F + 0.42F * valueNoise(3.F * d.x() + 9.F, 3.F * d.z() + 2.F * d.y(), seed);
        const Vec3f at = clump.centre + (0.62F + 0.38F * depth) * bump * clump.radius_m *
                                            Vec3f(d.x(), d.y(), 0.9F * d.z());
        const uint32_t shade = depth < 0.45F ? 3U : hash(h, 3U) % 3U;
        addTwig(mesh, at, (d + Vec3f(0, 0, 0.5F)).normalized(),
                growthOf(detail) * between(hash(h, 4U), 0.055F, 0.1F), greens[shade], hash(h, 5U));
    }
}

/// Low ground cover round a trunk.
void addBed(Mesh& mesh, const std::array<uint32_t, 4>& greens, uint32_t inner, uint32_t seed) {
    constexpr uint32_t kTwigs = 1800;
    const float radius = between(seed, 0.6F, 0.8F), height = between(hash(seed, 1U), 0.25F, 0.45F);
    addCore(mesh, Vec3f::Zero(), 0.75F * height, inner, seed);
    for (uint32_t i = 0; i < kTwigs; ++i) {
        const uint32_t h = hash(seed, 60U, i);
        const float a = between(hash(h, 1U), 0.F, 6.2831853F), r = std::sqrt(unit(hash(h, 2U)));
        const Vec3f d(std::cos(a) * r, std::sin(a) * r, 1.F);
        const float top = height * (1.F - 0.75F * r * r) *
                          (0.8F + 0.3F * valueNoise(4.F * d.x(), 4.F * d.y(), seed));
        const float depth = unit(hash(h, 3U));
        addTwig(mesh, {radius * d.x(), radius * d.y(), top * (0.6F + 0.4F * depth)}, d.normalized(),
                between(hash(h, 4U), 0.03F, 0.06F), greens[depth < 0.3F ? 3U : hash(h, 5U) % 3U],
                hash(h, 6U));
    }
}

}  // namespace

Mesh makeTree(uint32_t seed, LeafDetail detail) {
    constexpr uint32_t kTwigs = 1500;  // per clump
    constexpr std::size_t kClumps = 11;
    Mesh mesh;
    const float trunk = between(hash(seed, 1U), 1.8F, 2.6F),
                radius = between(hash(seed, 2U), 0.14F, 0.22F);
    const uint32_t bark = mesh.addFinish(Material::Trunk, {0.17F, 0.14F, 0.11F}, seed);
    const Vec3f fork(between(hash(seed, 3U), -0.25F, 0.25F), between(hash(seed, 4U), -0.25F, 0.25F),
                     trunk);
    mesh.addRod(Vec3f::Zero(), fork, radius, 0.8F * radius, 10, false, bark);
    std::array<Clump, kClumps> clumps;
    for (uint32_t k = 0; k < kClumps; ++k) {
        const bool upper = k >= 6;  // a ring of six, a ring of four above it, and the top
        const auto place = static_cast<float>(upper ? k - 6 : k);
        const float a = 6.2831853F * (place + unit(hash(seed, 30U, k))) / (upper ? 4.F : 6.F);
        const float out =
            k == 10 ? 0.F : between(hash(seed, 31U, k), upper ? 0.6F : 1.1F, upper ? 1.1F : 1.75F);
        const float up = between(hash(seed, 32U, k), upper ? 2.0F : 0.7F, upper ? 2.7F : 1.7F) +
                         (k == 10 ? 0.6F : 0.F);
        clumps[k] = {fork + Vec3f(out * std::cos(a), out * std::sin(a), up),
                     between(hash(seed, 33U, k), 0.75F, 1.15F)};
        const Vec3f elbow =
            fork + 0.5F * (clumps[k].centre - fork) + 0.25F * onSphere(hash(seed, 34U, k));
        mesh.addRod(fork, elbow, 0.5F * radius, 0.33F * radius, 6, false, bark);
        mesh.addRod(elbow, clumps[k].centre, 0.33F * radius, 0.12F * radius, 6, false, bark);
    }
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
    const auto greens = leafFinishes(mesh, seed);
    const uint32_t inner = mesh.addFinish(Material::Leaf, {0.085F, 0.11F, 0.042F}, seed);
    for (uint32_t k = 0; k < kClumps; ++k) {
        addCore(mesh, clumps[k].centre, 0.64F * clumps[k].radius_m, inner, hash(seed, 35U, k));
        addClump(mesh, clumps[k], kTwigs, greens, hash(seed, 36U, k), detail);
    }
    if (seed % 2U == 0 && detail == LeafDetail::Fine) addBed(mesh, greens, inner, hash(seed, 37U));
    return mesh;
}

Mesh makeHedge(uint32_t seed, LeafDetail detail) {
    constexpr uint32_t kTwigs = 5500;
    const Vec3f half(1.02F, 0.4F, 0.72F);
    Mesh mesh;
    const auto greens = leafFinishes(mesh, seed);
    const uint32_t core = mesh.addFinish(Material::Leaf, {0.095F, 0.125F, 0.045F}, seed);
    mesh.addBox(Vec3f(0, 0, 0.02F), {2.02F, 0.5F, 1.25F}, Vec3f::UnitX(), core);
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
    for (uint32_t i = 0; i < kTwigs; i += shareOf(detail)) {
        const uint32_t h = hash(seed, 50U, i), face = hash(h, 1U) % 9U;
        Vec3f p(between(hash(h, 2U), -1.F, 1.F), between(hash(h, 3U), -1.F, 1.F),
                between(hash(h, 4U), -1.F, 1.F));
        Vec3f d = Vec3f::UnitZ();
        if (face < 6) {  // long sides
            p.y() = face < 3 ? -1.F : 1.F;
            d = Vec3f(0, p.y(), 0.5F);
        } else {
            p.z() = 1.F;
        }
        const float in = 1.F - 0.22F * unit(hash(h, 5U)) * unit(hash(h, 6U));
        const float wave = 0.06F * valueNoise(3.F * p.x(), 2.F * p.z(), seed);
        const Vec3f at = Vec3f(0, 0, 0.78F) + in * p.cwiseProduct(half) + wave * d;
        addTwig(mesh, at, d.normalized(), growthOf(detail) * between(hash(h, 7U), 0.03F, 0.06F),
                greens[hash(h, 8U) % 4U], hash(h, 9U));
    }
    return mesh;
}

}  // namespace djpete::simulator
