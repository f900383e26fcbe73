#include <algorithm>
#include <cmath>

#include "car_body.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

constexpr uint32_t kSides = 22;

/// A ring of a wheel: how far inside its outer face, and its radius over the wheel's.
struct Step {
    float depth_m, radius;
};
/// From the inner face over the tread to the dished rim.
constexpr Step kProfile[] = {{0.200F, 0.60F}, {0.196F, 0.93F}, {0.175F, 1.00F}, {0.022F, 1.00F},
                             {0.004F, 0.95F}, {0.F, 0.80F},    {0.008F, 0.68F}, {0.040F, 0.62F},
                             {0.030F, 0.22F}, {0.012F, 0.18F}, {0.012F, 0.00F}};

/// uv of a wheel is the place in its plane, in metres from the hub, turned by a random angle.
void addWheel(Mesh& mesh, const Vec3f& outer, float side, float radius, float turn,
              uint32_t finish) {
    const uint32_t patch = mesh.newPatch();
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
    std::vector<uint32_t> before, ring;
    for (const auto& step : kProfile) {
        ring.clear();
        for (uint32_t i = 0; i < kSides; ++i) {
            const float a =
                2.F * static_cast<float>(M_PI) * static_cast<float>(i) / static_cast<float>(kSides);
            const float r = step.radius * radius;
            const Vec3f p = outer + Vec3f(r * std::cos(a), -side * step.depth_m, r * std::sin(a));
            ring.push_back(mesh.addVertex(p, {r * std::cos(a + turn), r * std::sin(a + turn)}));
        }
        for (uint32_t i = 0; i < kSides && !before.empty(); ++i) {
            const uint32_t j = (i + 1) % kSides;
            uint32_t a = before[i], b = before[j], c = ring[j], d = ring[i];
            if (side < 0) {
                std::swap(a, b);
                std::swap(c, d);
            }
            mesh.addTriangle(a, c, b, finish, patch);
            if (step.radius > 0) mesh.addTriangle(a, d, c, finish, patch);
        }
        std::swap(before, ring);
    }
}

}  // namespace

void addWheels(Mesh& mesh, const CarOutline& o, uint32_t seed) {
    const uint32_t tyre = mesh.addFinish(Material::Tyre, Vec3f::Ones(), seed);
    uint32_t n = 0;
    for (float x : {o.wheelRear, o.wheelFront}) {
        for (float side : {-1.F, 1.F}) {
            const float y = 0.5F * o.width_m - 0.035F;
            addWheel(mesh, Vec3f(x * o.length_m, side * y, o.wheelRadius_m), side, o.wheelRadius_m,
                     between(hash(seed, 9U, n++), 0.F, 6.28F), tyre);
        }
    }
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
}

void addMirrors(Mesh& mesh, const CarOutline& o, uint32_t paint) {
    const float x = (o.cowl - 0.055F) * o.length_m, z = o.belt * o.height_m + 0.035F;
    const float half = o.halfWidthAt(o.cowl - 0.055F);
    const float tall = o.van ? 0.26F : 0.14F;
    const uint32_t glass = mesh.addFinish(Material::Frame, Vec3f::Constant(0.05F), 0);
    for (float side : {-1.F, 1.F}) {
        const float inner = 0.83F * half, outer = half + 0.065F;
        const float y = side * 0.5F * (inner + outer), depth = 0.10F;
        // A housing that tapers ahead; its back carries the glass.
        const float hy = 0.5F * (outer - inner);
        const Vec3f back(x - 0.5F * depth, y, z), front(x + 0.5F * depth, y, z + 0.02F);
        const auto corner = [&](const Vec3f& c, float sy, float up, float shrink) {
            return Vec3f(c.x(), c.y() + sy * shrink * hy, c.z() + up * shrink * tall);
        };
        const Vec3f b0 = corner(back, -1, 0, 1), b1 = corner(back, 1, 0, 1),
                    b2 = corner(back, 1, 1, 1), b3 = corner(back, -1, 1, 1);
        const Vec3f f0 = corner(front, -1, 0, 0.7F), f1 = corner(front, 1, 0, 0.7F),
                    f2 = corner(front, 1, 1, 0.7F), f3 = corner(front, -1, 1, 0.7F);
        mesh.addQuad(b1, b0, b3, b2, glass, mesh.newPatch());
        const uint32_t patch = mesh.newPatch();
        mesh.addQuad(f0, f1, f2, f3, paint, patch);
        mesh.addQuad(b0, f0, f3, b3, paint, patch);
        mesh.addQuad(f1, b1, b2, f2, paint, patch);
        mesh.addQuad(b3, f3, f2, b2, paint, patch);
        mesh.addQuad(f0, b0, b1, f1, paint, patch);
    }
}

void addRoofRack(Mesh& mesh, const CarOutline& o, uint32_t finish) {
    const float rear = o.rearHead + 0.05F, front = o.van ? 0.15F : std::min(0.02F, o.cowl - 0.2F);
    const auto at = [&](float x, float side) {
        const float z = o.topAt(x) * o.height_m, above = (1.F - o.belt) * o.height_m;
        const float y = 0.945F * o.halfWidthAt(x) - o.lean * above - 0.10F;
        return Vec3f(x * o.length_m, side * y, z);
    };
    const Vec3f up(0, 0, 0.055F), foot(0, 0, -0.02F);
    for (float side : {-1.F, 1.F}) {
        constexpr int kPieces = 4;
        for (int i = 0; i < kPieces; ++i) {
            const float f = static_cast<float>(i) / kPieces;
            const Vec3f a = at(rear + f * (front - rear), side),
                        b = at(rear + (f + 1.F / kPieces) * (front - rear), side);
            mesh.addRod(a + up, b + up, 0.014F, 0.014F, 6, i == 0 || i + 1 == kPieces, finish);
            mesh.addRod(a + foot, a + up, 0.016F, 0.012F, 6, false, finish);
        }
    }
    for (float f : {0.2F, 0.75F}) {
        const float x = rear + f * (front - rear);
        mesh.addRod(at(x, -1) + up, at(x, 1) + up, 0.014F, 0.014F, 6, false, finish);
    }
}

}  // namespace djpete::simulator
