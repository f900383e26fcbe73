#include "car_body.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

CarOutline outlineOf(uint32_t kind) {
    CarOutline o;
    switch (kind) {
        case 0:  // hatchback
            o = {3.95F,
                 1.70F,
                 1.48F,
                 {{-.5F, .36F},
                  {-.497F, .60F},
                  {-.475F, .68F},
                  {-.41F, .91F},
                  {-.36F, .975F},
                  {-.08F, 1.F},
                  {.06F, .975F},
                  {.255F, .675F},
                  {.42F, .60F},
                  {.48F, .52F},
                  {.5F, .36F}}};
            o.rearFoot = -.475F, o.rearHead = -.40F, o.sideRear = -.40F, o.pillar = -.045F,
            o.pillar2 = -.27F, o.belt = .645F;
            break;
        case 1:  // saloon
            o = {4.60F,
                 1.79F,
                 1.44F,
                 {{-.5F, .38F},
                  {-.496F, .62F},
                  {-.47F, .68F},
                  {-.35F, .70F},
                  {-.20F, .945F},
                  {-.13F, .985F},
                  {0.F, 1.F},
                  {.08F, .975F},
                  {.235F, .685F},
                  {.42F, .60F},
                  {.485F, .51F},
                  {.5F, .36F}}};
            o.rearFoot = -.345F, o.rearHead = -.205F, o.sideRear = -.28F, o.pillar = -.055F,
            o.pillar2 = -.225F, o.belt = .66F, o.cowl = .235F;
            break;
        case 2:  // estate
            o = {4.70F,
                 1.80F,
                 1.49F,
                 {{-.5F, .36F},
                  {-.497F, .60F},
                  {-.485F, .68F},
                  {-.435F, .92F},
                  {-.39F, .975F},
                  {-.06F, 1.F},
                  {.07F, .975F},
                  {.235F, .68F},
                  {.42F, .60F},
                  {.485F, .51F},
                  {.5F, .36F}}};
            o.rearFoot = -.485F, o.rearHead = -.43F, o.sideRear = -.42F, o.pillar = -.045F,
            o.pillar2 = -.235F, o.belt = .65F, o.cowl = .235F;
            break;
        case 3:  // SUV
            o = {4.45F,
                 1.86F,
                 1.70F,
                 {{-.5F, .38F},
                  {-.497F, .62F},
                  {-.485F, .68F},
                  {-.44F, .93F},
                  {-.40F, .98F},
                  {-.05F, 1.F},
                  {.07F, .98F},
                  {.225F, .70F},
                  {.43F, .645F},
                  {.485F, .56F},
                  {.5F, .40F}}};
            o.rearFoot = -.485F, o.rearHead = -.435F, o.sideRear = -.41F, o.pillar = -.05F,
            o.pillar2 = -.26F, o.belt = .665F, o.cowl = .225F;
            o.wheelRadius_m = .36F, o.clearance_m = .25F;
            break;
        case kVan:
            o = {4.95F,
                 1.92F,
                 1.98F,
                 {{-.5F, .28F},
                  {-.499F, .60F},
                  {-.494F, .90F},
                  {-.475F, .985F},
                  {-.1F, 1.F},
                  {.18F, .985F},
                  {.235F, .955F},
                  {.385F, .575F},
                  {.465F, .49F},
                  {.493F, .40F},
                  {.5F, .28F}}};
            o.rearFoot = -.497F, o.rearHead = -.49F, o.sideRear = .075F, o.pillar = -1.F,
            o.belt = .555F, o.cowl = .385F;
            o.wheelFront = .335F, o.wheelRear = -.28F, o.wheelRadius_m = .34F;
            break;
        case 5:  // city car
            o = {3.45F,
                 1.62F,
                 1.50F,
                 {{-.5F, .36F},
                  {-.497F, .62F},
                  {-.485F, .70F},
                  {-.44F, .93F},
                  {-.40F, .98F},
                  {-.05F, 1.F},
                  {.10F, .975F},
                  {.30F, .67F},
                  {.44F, .60F},
                  {.485F, .52F},
                  {.5F, .36F}}};
            o.rearFoot = -.485F, o.rearHead = -.435F, o.sideRear = -.40F, o.pillar = -.13F,
            o.belt = .64F, o.cowl = .30F;
            o.wheelFront = .34F, o.wheelRear = -.33F, o.wheelRadius_m = .285F;
            break;
        default:  // pick-up
            o = {5.20F,
                 1.86F,
                 1.78F,
                 {{-.5F, .36F},
                  {-.498F, .57F},
                  {-.49F, .605F},
                  {-.16F, .605F},
                  {-.15F, .62F},
                  {-.12F, .94F},
                  {-.08F, .985F},
                  {.02F, 1.F},
                  {.09F, .975F},
                  {.215F, .675F},
                  {.43F, .625F},
                  {.488F, .55F},
                  {.5F, .38F}}};
            o.rearFoot = -.147F, o.rearHead = -.118F, o.sideRear = -.105F, o.pillar = .03F,
            o.belt = .635F, o.cowl = .215F;
            o.wheelRadius_m = .38F, o.clearance_m = .28F;
            break;
    }
    return o;
}

/// Two rounds of corner cutting; ends stay.
std::vector<Vec2f> smoothed(std::vector<Vec2f> line) {
    for (int round = 0; round < 2; ++round) {
        std::vector<Vec2f> out{line.front()};
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            out.emplace_back(0.8F * line[i] + 0.2F * line[i + 1]);
            out.emplace_back(0.2F * line[i] + 0.8F * line[i + 1]);
        }
        out.push_back(line.back());
        line = std::move(out);
    }
    return line;
}

std::vector<float> stationsOf(const CarOutline& o) {
    std::vector<float> out;
    for (const auto& p : o.top) {
        while (!out.empty() && p.x() - out.back() > 0.03F) out.push_back(out.back() + 0.025F);
        if (out.empty() || p.x() - out.back() > 1e-4F) out.push_back(p.x());
    }
    return out;
}

/// Points of one cross-section from the sill up the left side to the roof's middle; y >= 0.
std::vector<Vec2f> crossSection(const CarOutline& o, float x) {
    const float top = o.topAt(x) * o.height_m, belt = o.belt * o.height_m;
    const float end = std::max(0.F, (std::abs(x) - 0.40F) / 0.10F);
    const float low = o.clearance_m + 0.07F * end * end, half = o.halfWidthAt(x);
    const float shoulder = std::min(belt, top - 0.04F);
    const float above = std::max(0.F, top - shoulder), round = std::min(0.09F, 0.5F * above);
    const float lean = (o.belt < 0.6F ? 0.16F : 0.30F) * std::max(0.F, above - 0.04F);
    std::vector<Vec2f> p{
        {0.80F * half, low}, {0.955F * half, low + 0.015F}, {0.985F * half, low + 0.10F}};
    for (float f : {0.3F, 0.55F, 0.8F, 0.94F})
        p.emplace_back(half * (1.F - 0.02F * (2 * f - 1) * (2 * f - 1)),
                       low + 0.10F + f * (shoulder - low - 0.10F));
    p.emplace_back(0.955F * half, shoulder);
    const float foot = 0.945F * half, head = foot - lean;
    for (float f : {0.12F, 0.4F, 0.7F, 1.F})
        p.emplace_back(foot - f * lean, shoulder + f * (above - round));
    for (float a : {0.35F, 0.7F})
        p.emplace_back(head - round * a * a * 1.1F, top - round * (1.F - a) * (1.F - 0.4F * a));
    const float crown = std::min(0.03F, 0.3F * above);
    p.emplace_back(head - 1.5F * round, top - 0.35F * crown);
    p.emplace_back(0.5F * head, top - 0.08F * crown);
    p.emplace_back(0.F, top);
    return p;
}

void addShell(Mesh& mesh, const CarOutline& o, uint32_t finish) {
    const uint32_t patch = mesh.newPatch();
    std::vector<std::vector<uint32_t>> rings;
    for (float x : stationsOf(o)) {
        const auto half = crossSection(o, x);
        std::vector<uint32_t> ring;
        const auto add = [&](float y, float z) {
            const Vec3f p(x * o.length_m, y, z);
            ring.push_back(mesh.addVertex(p, {p.x(), p.z()}));
        };
        for (const auto& q : half) add(q.x(), q.y());
        for (std::size_t k = half.size() - 1; k-- > 0;) add(-half[k].x(), half[k].y());
        rings.push_back(ring);
    }
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        mesh.addTriangle(a, b, c, finish, patch);
        mesh.addTriangle(a, c, d, finish, patch);
    };
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const auto &r = rings[i], &f = rings[i + 1];
        for (std::size_t k = 0; k + 1 < r.size(); ++k) quad(r[k], f[k], f[k + 1], r[k + 1]);
    }
    mesh.smoothNormals();
    // Floor and ends have their own vertices, so that the shell's normals stay smooth.
    const auto copy = [&](uint32_t i) {
        return mesh.addVertex(Vec3f(mesh.vertices[i]),
                              Vec2f(mesh.vertices[i].x(), mesh.vertices[i].y()));
    };
    const uint32_t floor = mesh.newPatch();
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const uint32_t a = copy(rings[i].front()), b = copy(rings[i + 1].front()),
                       c = copy(rings[i + 1].back()), d = copy(rings[i].back());
        mesh.addTriangle(a, b, c, finish, floor);
        mesh.addTriangle(a, c, d, finish, floor);
    }
    for (const auto* ring : {&rings.front(), &rings.back()}) {
        const std::size_t n = ring->size();
        for (std::size_t k = 0; k + 1 < n / 2; ++k) {
            const uint32_t a = copy((*ring)[k]), b = copy((*ring)[k + 1]),
                           c = copy((*ring)[n - 2 - k]), d = copy((*ring)[n - 1 - k]);
            mesh.addTriangle(a, b, c, finish, patch);
            mesh.addTriangle(a, c, d, finish, patch);
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

float CarOutline::topAt(float x) const {
    const auto next = std::lower_bound(top.begin() + 1, top.end() - 1, x,
                                       [](const Vec2f& p, float at) { return p.x() < at; });
    const Vec2f &a = *(next - 1), &b = *next;
    const float f = std::clamp((x - a.x()) / std::max(1e-6F, b.x() - a.x()), 0.F, 1.F);
    return a.y() + f * (b.y() - a.y());
}

float CarOutline::halfWidthAt(float x) const {
    const float front = std::max(0.F, (x - 0.34F) / 0.16F),
                rear = std::max(0.F, (-x - 0.40F) / 0.10F);
    return (0.5F * width_m - 0.015F) * (1.F - 0.17F * front * front * front - 0.07F * rear * rear);
}

CarBody makeCarBody(uint32_t kind, uint32_t seed) {
    CarBody body;
    CarOutline& o = body.outline;
    o = outlineOf(kind);
    const float scale = between(hash(seed, 1), 0.95F, 1.05F);
    o.length_m *= scale * between(hash(seed, 2), 0.97F, 1.03F);
    o.width_m *= between(hash(seed, 4), 0.98F, 1.02F);
    o.height_m *= between(hash(seed, 3), 0.975F, 1.025F);
    o.top = smoothed(o.top);
    addShell(body.mesh, o, body.mesh.addFinish(Material::CarBody, Vec3f::Ones(), seed));
    const uint32_t tyre = body.mesh.addFinish(Material::Tyre, Vec3f::Ones(), seed);
    body.mesh.normals.resize(body.mesh.vertices.size(), Vec3f::Zero());
    for (float x : {o.wheelRear, o.wheelFront}) {
        for (float side : {-1.F, 1.F}) {
            const Vec3f outer(x * o.length_m, side * 0.5F * o.width_m, o.wheelRadius_m);
            body.mesh.addRod(outer - Vec3f(0, side * 0.21F, 0), outer, o.wheelRadius_m,
                             o.wheelRadius_m, 28, true, tyre);
        }
    }
    body.mesh.normals.resize(body.mesh.vertices.size(), Vec3f::Zero());
    body.size_m = centreOnBox(body.mesh);
    return body;
}

}  // namespace djpete::simulator
