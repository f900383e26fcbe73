#include "car_body.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

/// Where cross-sections are cut: dense where the upper line bends and around the wheel arches.
std::vector<float> stationsOf(const CarOutline& o) {
    constexpr int kArchSteps = 10;
    const float reach = o.archRadius_m() / o.length_m;
    std::vector<float> all;
    for (float wheel : {o.wheelRear, o.wheelFront}) {
        if (std::abs(wheel) > 0.5F) continue;  // not under this shell
        for (int i = 0; i <= kArchSteps; ++i)
            all.push_back(wheel - reach * std::cos(static_cast<float>(M_PI) *
                                                   static_cast<float>(i) / kArchSteps));
        for (float side : {-1.F, 1.F}) all.push_back(wheel + side * (reach + 0.0008F));
    }
    const auto inArch = [&](float x) {
        return std::min(std::abs(x - o.wheelRear), std::abs(x - o.wheelFront)) < reach + 0.006F;
    };
    float last = -1;
    for (const auto& p : o.top) {
        const bool end = p.x() == o.top.back().x();
        if (!end && (inArch(p.x()) || p.x() - last < 0.008F)) continue;
        last = p.x();
        all.push_back(p.x());
    }
    std::sort(all.begin(), all.end());
    std::vector<float> out;
    for (float x : all) {
        while (!out.empty() && x - out.back() > 0.045F) out.push_back(out.back() + 0.04F);
        out.push_back(x);
    }
    return out;
}

/// Points of one cross-section from the sill up the left side to the roof's middle; y >= 0.
std::vector<Vec2f> crossSection(const CarOutline& o, float x) {
    const float top = o.topAt(x) * o.height_m, belt = o.belt * o.height_m;
    const float low = o.lowAt(x), half = o.halfWidthAt(x);
    const float shoulder = std::min(belt, top - 0.04F);
    const float above = std::max(0.F, top - shoulder), round = std::min(0.09F, 0.5F * above);
    const float lean = o.lean * std::max(0.F, above - 0.04F);
    const float room = shoulder - low, sill = std::min(0.10F, 0.4F * room);
    std::vector<Vec2f> p{
        {0.80F * half, low}, {0.955F * half, low + 0.15F * sill}, {0.985F * half, low + sill}};
    // The flank bulges to a crease below the windows.
    static constexpr float kBulge[4][2] = {
        {0.3F, 0.986F}, {0.62F, 0.995F}, {0.80F, 1.F}, {0.92F, 0.984F}};
    for (const auto& b : kBulge)
        p.emplace_back(half * b[1], low + sill + b[0] * (shoulder - low - sill));
    p.emplace_back(0.955F * half, shoulder);
    const float foot = 0.945F * half, head = foot - lean;
    for (float f : {0.12F, 0.5F, 1.F})
        p.emplace_back(foot - f * lean, shoulder + f * (above - round));
    for (float a : {0.35F, 0.7F})
        p.emplace_back(head - round * a * a * 1.1F, top - round * (1.F - a) * (1.F - 0.4F * a));
    const float crown = std::min(0.03F, 0.3F * above);
    p.emplace_back(head - 1.5F * round, top - 0.35F * crown);
    p.emplace_back(0.5F * head, top - 0.08F * crown);
    p.emplace_back(0.F, top);
    return p;
}

using Ring = std::vector<uint32_t>;

/// A disc that closes an end of the shell; `forward`: it faces ahead.
void addEnd(Mesh& mesh, const Ring& ring, bool forward, uint32_t finish, uint32_t patch) {
    const std::size_t n = ring.size();
    const auto copy = [&](std::size_t k) {
        const Vec3f p = mesh.vertices[ring[k]];
        return mesh.addVertex(p, {p.y(), p.z()});
    };
    for (std::size_t k = 0; k + 1 < n / 2; ++k) {
        const uint32_t a = copy(k), b = copy(k + 1), c = copy(n - 2 - k), d = copy(n - 1 - k);
        if (forward) {
            mesh.addTriangle(a, b, c, finish, patch);
            mesh.addTriangle(a, c, d, finish, patch);
        } else {
            mesh.addTriangle(a, c, b, finish, patch);
            mesh.addTriangle(a, d, c, finish, patch);
        }
    }
}

/// Dark metal between the wheels, which closes the wheel arches.
void addUnderbody(Mesh& mesh, const CarOutline& o) {
    const uint32_t dark = mesh.addFinish(Material::Metal, Vec3f::Constant(0.012F), 0);
    const float bottom = o.clearance_m + 0.03F, width = o.width_m - 0.56F;
    const float top =
        std::min(o.wheelRadius_m + o.archRadius_m() + 0.02F, o.topAt(0.40F) * o.height_m - 0.06F);
    mesh.addBox(Vec3f(0, 0, bottom), Vec3f(0.84F * o.length_m, width, top - bottom), Vec3f::UnitX(),
                dark);
}

}  // namespace

void addShell(Mesh& mesh, const CarOutline& o, uint32_t finish) {
    const uint32_t patch = mesh.newPatch();
    std::vector<Ring> rings;
    for (float x : stationsOf(o)) {
        const auto half = crossSection(o, x);
        Ring ring;
        const auto add = [&](float y, float z) {
            ring.push_back(mesh.addVertex(Vec3f(x * o.length_m, y, z), {x * o.length_m, z}));
        };
        for (const auto& q : half) add(q.x(), q.y());
        for (std::size_t k = half.size() - 1; k-- > 0;) add(-half[k].x(), half[k].y());
        rings.push_back(ring);
    }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const auto &r = rings[i], &f = rings[i + 1];
        for (std::size_t k = 0; k + 1 < r.size(); ++k) {
            mesh.addTriangle(r[k], r[k + 1], f[k + 1], finish, patch);
            mesh.addTriangle(r[k], f[k + 1], f[k], finish, patch);
        }
    }
    mesh.smoothNormals();
    // Floor and ends have their own vertices, so that the shell's normals stay smooth.
    const uint32_t floor = mesh.newPatch();
    const auto copy = [&](uint32_t i) {
        const Vec3f p = mesh.vertices[i];
        return mesh.addVertex(p, {p.x(), p.y()});
    };
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const uint32_t a = copy(rings[i].front()), b = copy(rings[i + 1].front()),
                       c = copy(rings[i + 1].back()), d = copy(rings[i].back());
        mesh.addTriangle(a, b, c, finish, floor);
        mesh.addTriangle(a, c, d, finish, floor);
    }
    addEnd(mesh, rings.front(), false, finish, patch);
    addEnd(mesh, rings.back(), true, finish, patch);
    addUnderbody(mesh, o);
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
}

void centreOnBox(CarBody& body) {
    Mesh& mesh = body.mesh;
    mesh.normals.resize(mesh.vertices.size(), Vec3f::Zero());
    Vec3f low = mesh.vertices.front(), high = low;
    for (const auto& p : mesh.vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Vec3f centre = 0.5F * (low + high);
    for (auto& p : mesh.vertices) p -= centre;
    body.outline.origin_obj -= centre;
    body.size_m = (high - low).cast<double>();
}

CarBody makeCarBody(uint32_t kind, uint32_t seed) {
    CarBody body;
    CarOutline& o = body.outline;
    o = makeOutline(kind, seed);
    body.look = makeLook(seed, o.van);
    const uint32_t paint = body.mesh.addFinish(Material::CarBody, Vec3f::Ones(), seed);
    addShell(body.mesh, o, paint);
    addWheels(body.mesh, o, seed);
    addMirrors(body.mesh, o, paint);
    const bool tall = kind == 2 || kind == 3 || kind == 8 || kind == kMinibus;
    body.look.rack = body.look.rack && (tall || o.van);
    if (body.look.rack) {
        const float tone = unit(hash(seed, 8U)) < 0.5F ? 0.30F : 0.025F;
        addRoofRack(body.mesh, o,
                    body.mesh.addFinish(Material::Metal, Vec3f::Constant(tone), seed));
    }
    centreOnBox(body);
    return body;
}

}  // namespace djpete::simulator
