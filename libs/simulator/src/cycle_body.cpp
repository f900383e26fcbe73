#include <algorithm>
#include <cmath>

#include "noise.h"
#include "person_body.h"

namespace djpete::simulator {
namespace {

constexpr float kPi = 3.14159265F;

/// Where a rider touches the bicycle; plane of the wheels y = 0, ground z = 0.
struct Bicycle {
    uint32_t seed = 0;
    float wheel_m = 0.345F;
    Vec3f rear, front, bottom, saddle, head, stem;
    float bar = 0.28F;  ///< half of the handlebar's width
};

Bicycle makeBicycle(const Figure& f) {
    Bicycle b;
    b.seed = f.seed;
    const float leg = 0.49F * f.height_m;
    b.rear = Vec3f(-0.52F, 0, b.wheel_m);
    b.front = Vec3f(0.55F, 0, b.wheel_m);
    b.bottom = Vec3f(-0.08F, 0, 0.285F);
    b.saddle = b.bottom + (leg - 0.22F) * Vec3f(-0.26F, 0, 0.966F);
    b.head = Vec3f(0.36F, 0, 0.80F);
    const bool upright = unit(hash(f.seed, 620U)) < 0.6F;
    b.stem = Vec3f(upright ? 0.26F : 0.36F, 0, b.saddle.z() + (upright ? 0.10F : -0.02F));
    return b;
}

/// uv: the place in the wheel's plane, metres from the hub.
void addBicycleWheel(Mesh& mesh, const Vec3f& hub, float radius, uint32_t finish, float turn) {
    constexpr uint32_t kAround = 24, kSpokes = 10;
    const uint32_t patch = mesh.newPatch();
    // Across: outer, left, inner, right of the tyre.
    static constexpr float kTyre[4][2] = {{0, 0}, {0.018F, 0.022F}, {0, 0.05F}, {-0.018F, 0.022F}};
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.normals.resize(first, Vec3f::Zero());
    for (uint32_t i = 0; i < kAround; ++i) {
        const float a = 2.F * kPi * static_cast<float>(i) / kAround;
        const Vec3f out(std::cos(a), 0, std::sin(a));
        for (uint32_t k = 0; k < 4; ++k) {
            const float r = radius - kTyre[k][1];
            mesh.addVertex(hub + r * out + Vec3f(0, kTyre[k][0], 0), {r * out.x(), r * out.z()});
            mesh.normals.push_back(k == 0   ? out
                                   : k == 2 ? Vec3f(-out)
                                            : Vec3f(0, k == 1 ? 1.F : -1.F, 0));
        }
    }
    for (uint32_t i = 0; i < kAround; ++i) {
        const uint32_t p = first + 4 * i, q = first + 4 * ((i + 1) % kAround);
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t m = (k + 1) % 4;
            mesh.addTriangle(p + k, p + m, q + m, finish, patch);
            mesh.addTriangle(p + k, q + m, q + k, finish, patch);
        }
    }
    const uint32_t steel = mesh.addFinish(Material::Metal, Vec3f::Constant(0.40F), 0);
    for (uint32_t i = 0; i < kSpokes; ++i) {
        const float a = turn + 2.F * kPi * static_cast<float>(i) / kSpokes;
        const float side = i % 2 == 0 ? 0.02F : -0.02F;
        mesh.addRod(hub + Vec3f(0, side, 0),
                    hub + (radius - 0.045F) * Vec3f(std::cos(a), 0, std::sin(a)), 0.0022F, 0.0022F,
                    3, false, steel);
    }
    mesh.addRod(hub - Vec3f(0, 0.05F, 0), hub + Vec3f(0, 0.05F, 0), 0.022F, 0.022F, 8, true, steel);
}

/// The two cranks with their pedals; `steel`, `dark`: finishes.
void addCranks(Mesh& mesh, const Bicycle& b, float crank, uint32_t steel, uint32_t dark) {
    for (float side : {1.F, -1.F}) {
        const float a = side > 0 ? crank : crank + kPi;
        const Vec3f arm = b.bottom + 0.17F * Vec3f(std::cos(a), 0, -std::sin(a));
        mesh.addRod(b.bottom + Vec3f(0, side * 0.06F, 0), arm + Vec3f(0, side * 0.07F, 0), 0.012F,
                    0.012F, 6, true, steel);
        mesh.addBox(arm + Vec3f(0, side * 0.12F, -0.012F), Vec3f(0.10F, 0.09F, 0.024F),
                    Vec3f::UnitX(), dark);
    }
}

/// Everything of a bicycle but its cranks.
void addBicycle(Mesh& mesh, const Bicycle& b, uint32_t steel, uint32_t dark) {
    const uint32_t seed = b.seed;
    static const Vec3f kPaints[6] = {{0.02F, 0.02F, 0.022F}, {0.40F, 0.02F, 0.02F},
                                     {0.03F, 0.12F, 0.35F},  {0.55F, 0.55F, 0.53F},
                                     {0.05F, 0.22F, 0.10F},  {0.50F, 0.30F, 0.02F}};
    const uint32_t frame =
        mesh.addFinish(Material::BikeFrame, kPaints[hash(seed, 621U) % 6U], seed);
    const uint32_t wheel = mesh.addFinish(Material::BikeWheel, Vec3f::Ones(), seed);
    addBicycleWheel(mesh, b.rear, b.wheel_m, wheel, 0.F);
    addBicycleWheel(mesh, b.front, b.wheel_m, wheel, 0.2F);
    const auto tube = [&](const Vec3f& from, const Vec3f& to, float r, uint32_t finish) {
        mesh.addRod(from, to, r, r, 6, true, finish);
    };
    const Vec3f seatTop = b.bottom + 0.82F * (b.saddle - b.bottom);
    const bool lowStep = unit(hash(seed, 622U)) < 0.4F;
    tube(b.bottom, seatTop, 0.017F, frame);
    tube(seatTop, b.saddle - Vec3f(0, 0, 0.03F), 0.013F, steel);
    tube(b.bottom, b.head - Vec3f(-0.03F, 0, 0.1F), 0.021F, frame);
    tube(b.bottom + (lowStep ? 0.35F : 0.95F) * (seatTop - b.bottom), b.head, 0.017F, frame);
    tube(b.head - Vec3f(-0.04F, 0, 0.13F), b.head + Vec3f(-0.02F, 0, 0.06F), 0.021F, frame);
    tube(b.head + Vec3f(-0.02F, 0, 0.06F), b.stem, 0.013F, steel);
    for (float side : {1.F, -1.F}) {
        const Vec3f y(0, side * 0.055F, 0);
        tube(b.rear + y, b.bottom + 0.5F * y, 0.010F, frame);
        tube(b.rear + y, seatTop + 0.4F * y, 0.009F, frame);
        tube(b.front + y, b.head - Vec3f(-0.04F, 0, 0.12F) + 0.6F * y, 0.012F, frame);
        const Vec3f grip = b.stem + Vec3f(-0.10F, side * b.bar, 0);
        tube(b.stem, grip + Vec3f(0.10F, -side * 0.08F, 0), 0.012F, steel);
        tube(grip + Vec3f(0.10F, -side * 0.08F, 0), grip, 0.016F, dark);
    }
    // Saddle, chain ring, mudguards' ends with lights, and a carrier on some.
    std::vector<Section> saddle;
    static constexpr float kSaddle[5][2] = {
        {-0.13F, 0.F}, {-0.12F, 0.07F}, {-0.02F, 0.06F}, {0.12F, 0.022F}, {0.14F, 0.F}};
    for (const auto& k : kSaddle)
        saddle.push_back(
            {b.saddle + Vec3f(k[0], 0, -0.01F), Vec3f(0, k[1], 0), Vec3f(0, 0, 0.4F * k[1])});
    addLoft(mesh, saddle, 8, dark);
    tube(b.bottom + Vec3f(0, -0.035F, 0), b.bottom + Vec3f(0, -0.045F, 0), 0.09F, dark);
    const uint32_t red = mesh.addFinish(Material::Metal, Vec3f(0.42F, 0.02F, 0.02F), seed);
    const Vec3f lamp = seatTop - Vec3f(0.03F, 0, 0.02F);
    tube(lamp, lamp - Vec3f(0.04F, 0, 0), 0.025F, red);
    tube(b.head + Vec3f(0.06F, 0, -0.02F), b.head + Vec3f(0.10F, 0, -0.02F), 0.04F, steel);
    if (unit(hash(seed, 623U)) < 0.5F) {
        const float z = 2 * b.wheel_m + 0.05F;
        mesh.addBox(Vec3f(-0.52F, 0, z), Vec3f(0.34F, 0.13F, 0.02F), Vec3f::UnitX(), dark);
        for (float side : {1.F, -1.F})
            tube(b.rear + Vec3f(0, side * 0.06F, 0), Vec3f(-0.54F, side * 0.06F, z), 0.006F, dark);
        if (unit(hash(seed, 624U)) < 0.5F)
            mesh.addBox(Vec3f(-0.52F, 0, z + 0.02F), Vec3f(0.36F, 0.28F, 0.22F), Vec3f::UnitX(),
                        mesh.addFinish(Material::Cloth, kPaints[hash(seed, 625U) % 6U],
                                       2U * hash(seed, 626U)));
    }
}

/// Who rides, on what, and how the trunk leans.
struct Rider {
    Figure figure;
    Bicycle bicycle;
    Vec3f hips;
    float lean = 0.1F;
    uint32_t steel = 0, dark = 0;  // finishes

    Vec3f shoulder(float side) const {
        const float w = figure.height_m * figure.girth;
        return onTrunk(figure, hips, lean, 0.262F, side * (0.098F * w + 0.012F * figure.height_m));
    }
    Vec3f grip(float side) const {
        return bicycle.stem + Vec3f(-0.08F, side * bicycle.bar, 0.025F);
    }
};

/// Adds what is the same in all shapes: the bicycle, trunk, head and arms.
Rider addRider(Mesh& mesh, uint32_t seed) {
    Rider r;
    Figure& f = r.figure;
    f = makeFigure(mesh, seed);
    f.coat = f.skirt = f.handbag = false;
    const bool helmet = unit(hash(seed, 627U)) < 0.45F;
    if (helmet) f.hat = f.longHair = false;
    r.bicycle = makeBicycle(f);
    r.steel = mesh.addFinish(Material::Metal, Vec3f::Constant(0.35F), seed);
    r.dark = mesh.addFinish(Material::Metal, Vec3f::Constant(0.03F), seed);
    addBicycle(mesh, r.bicycle, r.steel, r.dark);
    const float h = f.height_m;
    r.hips = r.bicycle.saddle + Vec3f(0, 0, 0.062F * h);
    // The trunk leans so far that the arms reach the grips slightly bent.
    while (r.lean < 1.0F && (r.grip(1) - r.shoulder(1)).norm() > 0.30F * h) r.lean += 0.02F;
    addTrunk(mesh, f, r.hips, r.lean);
    addHead(mesh, f, onTrunk(f, r.hips, r.lean, 0.318F, 0), 0.35F * r.lean, helmet);
    for (float side : {1.F, -1.F})
        addArm(mesh, f, r.shoulder(side),
               middleJoint(r.shoulder(side), r.grip(side), 0.172F * h, 0.155F * h,
                           Vec3f(-0.3F, side * 0.6F, -1)),
               r.grip(side));
    return r;
}

void addLegs(Mesh& mesh, const Rider& r, float crank) {
    const float h = r.figure.height_m, w = h * r.figure.girth;
    for (float side : {1.F, -1.F}) {
        const float a = side > 0 ? crank : crank + kPi;
        const Vec3f pedal = r.bicycle.bottom + 0.17F * Vec3f(std::cos(a), 0, -std::sin(a)) +
                            Vec3f(0, side * 0.12F, 0.012F);
        const float tilt = -0.15F - 0.2F * std::sin(a);
        const Vec3f toe(std::cos(tilt), 0, std::sin(tilt));
        const Vec3f ankle = pedal - 0.055F * h * toe + Vec3f(0, -side * 0.01F, 0.050F * h);
        const Vec3f hip = r.hips + Vec3f(0.015F * h, side * 0.048F * w, -0.02F * h);
        addLeg(mesh, r.figure, hip,
               middleJoint(hip, ankle, 0.245F * h, 0.246F * h, Vec3f(1, side * 0.1F, 0.3F)), ankle,
               toe);
    }
}

}  // namespace

std::vector<CarBody> makeCyclistShapes(uint32_t seed, uint32_t phases) {
    Mesh still;
    const Rider rider = addRider(still, seed);
    std::vector<Mesh> meshes(phases, still);
    for (uint32_t k = 0; k < phases; ++k) {
        const float crank = 2.F * kPi * static_cast<float>(k) / static_cast<float>(phases);
        addCranks(meshes[k], rider.bicycle, crank, rider.steel, rider.dark);
        addLegs(meshes[k], rider, crank);
    }
    return centreInCommonBox(std::move(meshes));
}

}  // namespace djpete::simulator
