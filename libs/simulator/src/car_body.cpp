#include "car_body.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

struct Outline {
    float length_m, width_m, height_m;
    /// (x / length, z / height) of the top line from rear to front.
    std::vector<Vec2f> top;
    float belt;  ///< lower edge of the windows / height
};

const std::array<Outline, kCarBodyKinds>& outlines() {
    static const std::array<Outline, kCarBodyKinds> all{{
        {3.95F,
         1.70F,
         1.48F,
         {{-.50F, .42F},
          {-.495F, .62F},
          {-.43F, .92F},
          {-.30F, .99F},
          {-.05F, 1.F},
          {.06F, .97F},
          {.27F, .66F},
          {.44F, .58F},
          {.50F, .40F}},
         .62F},
        {4.55F,
         1.78F,
         1.44F,
         {{-.50F, .44F},
          {-.49F, .63F},
          {-.33F, .67F},
          {-.19F, .95F},
          {-.04F, 1.F},
          {.05F, .97F},
          {.22F, .67F},
          {.44F, .58F},
          {.50F, .40F}},
         .64F},
        {4.70F,
         1.80F,
         1.50F,
         {{-.50F, .44F},
          {-.495F, .66F},
          {-.44F, .93F},
          {-.30F, .99F},
          {-.04F, 1.F},
          {.05F, .97F},
          {.22F, .66F},
          {.44F, .58F},
          {.50F, .40F}},
         .63F},
        {4.50F,
         1.88F,
         1.70F,
         {{-.50F, .45F},
          {-.495F, .70F},
          {-.45F, .95F},
          {-.30F, 1.F},
          {.00F, 1.F},
          {.07F, .97F},
          {.21F, .70F},
          {.45F, .64F},
          {.50F, .44F}},
         .66F},
        {4.90F,
         1.92F,
         1.98F,
         {{-.50F, .40F},
          {-.498F, .94F},
          {-.46F, 1.F},
          {.00F, 1.F},
          {.20F, .98F},
          {.36F, .66F},
          {.47F, .54F},
          {.50F, .36F}},
         .60F},
        {4.30F,
         1.80F,
         1.32F,
         {{-.50F, .46F},
          {-.49F, .66F},
          {-.38F, .74F},
          {-.20F, .96F},
          {-.08F, 1.F},
          {.02F, .97F},
          {.20F, .66F},
          {.44F, .56F},
          {.50F, .40F}},
         .66F},
    }};
    return all;
}

float heightAt(const Outline& o, float x) {
    for (std::size_t i = 1; i < o.top.size(); ++i) {
        if (x > o.top[i].x() && i + 1 < o.top.size()) continue;
        const Vec2f &a = o.top[i - 1], &b = o.top[i];
        const float f = std::clamp((x - a.x()) / (b.x() - a.x()), 0.F, 1.F);
        return a.y() + f * (b.y() - a.y());
    }
    return o.top.back().y();
}

/// Points of one cross-section, from the sill up the left side over the roof; y >= 0 half.
std::vector<Vec2f> crossSection(const Outline& o, float x, float clearance) {
    const float top = heightAt(o, x) * o.height_m;
    const float belt = std::min(o.belt * o.height_m, top);
    const float end = std::max(0.F, (std::abs(x) - 0.36F) / 0.14F);
    const float half = 0.5F * o.width_m * (1.F - 0.14F * end * end);
    const float above = std::max(0.F, top - belt);
    const float roofHalf = half - 0.30F * above - 0.04F;
    return {{0.90F * half, clearance},
            {half, clearance + 0.12F},
            {half, 0.5F * (clearance + belt)},
            {0.975F * half, belt},
            {0.5F * (0.975F * half + roofHalf), belt + 0.55F * above},
            {roofHalf, belt + 0.93F * above},
            {0.6F * roofHalf, top},
            {0.F, top}};
}

void addShell(Mesh& mesh, const Outline& o, uint32_t seed) {
    constexpr int kStations = 48;
    constexpr float kClearance = 0.20F;
    const Vec3f centre(0, 0, 0.5F * o.height_m);
    std::vector<std::vector<uint32_t>> rings;
    for (int i = 0; i <= kStations; ++i) {
        const float x = -0.5F + static_cast<float>(i) / kStations;
        const auto half = crossSection(o, x, kClearance);
        std::vector<uint32_t> ring;
        for (std::size_t k = 0; k < half.size(); ++k) {
            const Vec3f p(x * o.length_m, half[k].x(), half[k].y());
            ring.push_back(mesh.addVertex(p - centre, {p.x(), p.z()}));
        }
        for (std::size_t k = half.size() - 1; k-- > 0;) {
            const Vec3f p(x * o.length_m, -half[k].x(), half[k].y());
            ring.push_back(mesh.addVertex(p - centre, {p.x(), p.z()}));
        }
        rings.push_back(ring);
    }
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        mesh.addTriangle(a, b, c, Material::CarBody, seed);
        mesh.addTriangle(a, c, d, Material::CarBody, seed);
    };
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const auto &r = rings[i], &f = rings[i + 1];
        for (std::size_t k = 0; k + 1 < r.size(); ++k) quad(r[k], f[k], f[k + 1], r[k + 1]);
        quad(r.back(), f.back(), f.front(), r.front());  // floor
    }
    for (const auto* ring : {&rings.front(), &rings.back()}) {
        for (std::size_t k = 1; k + 1 < ring->size(); ++k) {
            mesh.addTriangle((*ring)[0], (*ring)[k], (*ring)[k + 1], Material::CarBody, seed);
        }
    }
}

/// Moves the mesh so that the box of its vertices is centred, and returns the box's size.
geometry::Vec3 centreOnBox(Mesh& mesh) {
    Vec3f low = mesh.vertices.front(), high = low;
    for (const auto& p : mesh.vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Vec3f centre = 0.5F * (low + high);
    for (auto& p : mesh.vertices) p -= centre;
    return (high - low).cast<double>();
}

}  // namespace

CarBody makeCarBody(uint32_t kind, uint32_t seed) {
    Outline o = outlines().at(kind);
    const float scale = between(hash(seed, 1), 0.96F, 1.04F);
    o.length_m *= scale * between(hash(seed, 2), 0.98F, 1.02F);
    o.width_m *= scale;
    o.height_m *= between(hash(seed, 3), 0.98F, 1.02F);
    CarBody body;
    body.wheelRadius_m = 0.31F + (o.height_m > 1.6F ? 0.04F : 0.F);
    body.wheelX_m = 0.31F * o.length_m;
    addShell(body.mesh, o, seed);
    body.mesh.smoothNormals();
    const float wheelZ = body.wheelRadius_m - 0.5F * o.height_m;
    for (float sx : {-1.F, 1.F}) {
        for (float sy : {-1.F, 1.F}) {
            const Vec3f at(sx * body.wheelX_m, sy * (0.5F * o.width_m - 0.10F), wheelZ);
            body.mesh.addCylinder(at, body.wheelRadius_m, 0.21F, true, Material::Tyre, seed);
        }
    }
    body.mesh.normals.resize(body.mesh.vertices.size(), Vec3f::Zero());  // wheels: flat
    body.size_m = centreOnBox(body.mesh);
    return body;
}

}  // namespace djpete::simulator
