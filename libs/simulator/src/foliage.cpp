#include "foliage.h"

#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

/// A leaf (or a small bunch of them) shaded like the crown's surface it sits on.
void addLeaf(Mesh& mesh, const Vec3f& at, const Vec3f& outward, float size, uint32_t finish,
             uint32_t h) {
    const Vec3f jitter(between(hash(h, 1U), -1.F, 1.F), between(hash(h, 2U), -1.F, 1.F),
                       between(hash(h, 3U), -1.F, 1.F));
    const Vec3f n = (0.6F * outward + 0.8F * jitter).normalized();
    const Vec3f x = n.unitOrthogonal(), y = n.cross(x);
    const float turn = between(hash(h, 4U), 0.F, 6.28F);
    const Vec3f u = size * (std::cos(turn) * x + std::sin(turn) * y);
    const Vec3f v = 0.62F * size * (std::cos(turn) * y - std::sin(turn) * x);
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.addVertex(at - u, {-size, 0});
    mesh.addVertex(at - 0.7F * v, {0, -size});
    mesh.addVertex(at + u, {size, 0});
    mesh.addVertex(at + 0.7F * v, {0, size});
    mesh.normals.insert(mesh.normals.end(), 4, (outward + 0.35F * jitter).normalized());
    const uint32_t patch = mesh.newPatch();
    mesh.addTriangle(first, first + 1, first + 2, finish, patch);
    mesh.addTriangle(first, first + 2, first + 3, finish, patch);
}

Vec3f onSphere(uint32_t h) {
    const float z = between(hash(h, 11U), -1.F, 1.F), a = between(hash(h, 12U), 0.F, 6.2831853F);
    const float r = std::sqrt(std::max(0.F, 1.F - z * z));
    return {r * std::cos(a), r * std::sin(a), z};
}

/// Greens of one plant, from sunlit to inner leaves.
std::array<uint32_t, 4> leafFinishes(Mesh& mesh, uint32_t seed) {
    const float f = unit(hash(seed, 20U));
    const Vec3f base = (1.F - f) * Vec3f(0.10F, 0.17F, 0.045F) + f * Vec3f(0.19F, 0.20F, 0.06F);
    return {mesh.addFinish(Material::Leaf, base, seed),
            mesh.addFinish(Material::Leaf, 1.3F * base, seed),
            mesh.addFinish(Material::Leaf, 0.75F * base, seed),
            mesh.addFinish(Material::Leaf, 0.5F * base, seed)};
}

}  // namespace

Mesh makeTree(uint32_t seed) {
    constexpr uint32_t kLeaves = 4200;
    Mesh mesh;
    const float trunk = between(hash(seed, 1U), 2.2F, 3.0F),
                radius = between(hash(seed, 2U), 0.11F, 0.2F);
    const uint32_t bark = mesh.addFinish(Material::Trunk, {0.17F, 0.13F, 0.10F}, seed);
    const Vec3f fork(between(hash(seed, 3U), -0.25F, 0.25F), between(hash(seed, 4U), -0.25F, 0.25F),
                     trunk);
    mesh.addRod(Vec3f::Zero(), fork, radius, 0.75F * radius, 10, false, bark);
    std::array<Vec3f, 7> clumps;
    std::array<float, 7> sizes{};
    for (uint32_t k = 0; k < clumps.size(); ++k) {
        const float a = 6.2831853F * (static_cast<float>(k) + unit(hash(seed, 30U, k))) / 6.F;
        const float out = k == 6 ? 0.F : between(hash(seed, 31U, k), 0.7F, 1.6F);
        clumps[k] = fork + Vec3f(out * std::cos(a), out * std::sin(a),
                                 between(hash(seed, 32U, k), 0.5F, 2.0F) + (k == 6 ? 1.F : 0.F));
        sizes[k] = between(hash(seed, 33U, k), 0.75F, 1.25F);
        mesh.addRod(fork, clumps[k], 0.5F * radius, 0.15F * radius, 6, false, bark);
    }
    const auto greens = leafFinishes(mesh, seed);
    for (uint32_t i = 0; i < kLeaves; ++i) {
        const uint32_t h = hash(seed, 40U, i), k = hash(h, 1U) % clumps.size();
        const Vec3f d = onSphere(h);
        const float depth = std::sqrt(unit(hash(h, 2U)));  // denser outside
        const float bump =
            0.85F + 0.35F * valueNoise(2.5F * d.x() + 9.F, 2.5F * d.z() + d.y(), seed + k);
        const Vec3f at = clumps[k] + (0.45F + 0.55F * depth) * bump * sizes[k] *
                                         Vec3f(d.x(), d.y(), 0.85F * d.z());
        const uint32_t shade = depth < 0.55F ? 3U : hash(h, 3U) % 3U;
        addLeaf(mesh, at, d, between(hash(h, 4U), 0.05F, 0.115F), greens[shade], hash(h, 5U));
    }
    return mesh;
}

Mesh makeHedge(uint32_t seed) {
    constexpr uint32_t kLeaves = 2400;
    const Vec3f half(1.02F, 0.4F, 0.72F);
    Mesh mesh;
    const auto greens = leafFinishes(mesh, seed);
    const uint32_t core = mesh.addFinish(Material::Leaf, {0.02F, 0.03F, 0.012F}, seed);
    mesh.addBox(Vec3f(0, 0, 0.02F), {2.02F, 0.5F, 1.25F}, Vec3f::UnitX(), core);
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
    for (uint32_t i = 0; i < kLeaves; ++i) {
        const uint32_t h = hash(seed, 50U, i), face = hash(h, 1U) % 9U;
        Vec3f p(between(hash(h, 2U), -1.F, 1.F), between(hash(h, 3U), -1.F, 1.F),
                between(hash(h, 4U), -1.F, 1.F));
        Vec3f d = Vec3f::UnitZ();
        if (face < 6) {  // long sides
            p.y() = face < 3 ? -1.F : 1.F;
            d = Vec3f(0, p.y(), 0.3F);
        } else {
            p.z() = 1.F;
        }
        const float in = 1.F - 0.22F * unit(hash(h, 5U)) * unit(hash(h, 6U));
        const float wave = 0.06F * valueNoise(3.F * p.x(), 2.F * p.z(), seed);
        const Vec3f at = Vec3f(0, 0, 0.78F) + in * p.cwiseProduct(half) + wave * d;
        addLeaf(mesh, at, d.normalized(), between(hash(h, 7U), 0.03F, 0.06F),
                greens[hash(h, 8U) % 4U], hash(h, 9U));
    }
    return mesh;
}

}  // namespace djpete::simulator
