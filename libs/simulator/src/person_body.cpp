#include "person_body.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

/// One leg's joints at an angle of the double step; 0: the foot passes the other leg.
struct Leg {
    float hip, knee, foot;  // rad: thigh ahead, knee bent, toes up
};
Leg legAt(float phase) {
    const float swing = std::sin(phase), forward = std::cos(phase);
    Leg leg{};
    leg.hip = 0.05F + 0.40F * swing;
    leg.knee = 0.08F + 0.74F * std::pow(std::max(0.F, std::cos(phase + 0.38F)), 1.5F);
    // Heel first ahead, toes last behind, flat between.
    leg.foot = swing > 0.5F ? 0.5F * (swing - 0.5F) : (swing < -0.4F ? 0.9F * (swing + 0.4F) : 0.F);
    if (forward > 0) leg.foot -= 0.25F * forward;
    return leg;
}

Mesh walkingMesh(uint32_t seed, float phase) {
    Mesh mesh;
    const Figure f = makeFigure(mesh, seed);
    const float h = f.height_m, w = h * f.girth, lean = 0.05F;
    const Vec3f hips = Vec3f::Zero();
    constexpr float kPi = 3.14159265F;
    for (float side : {1.F, -1.F}) {
        const float own = side > 0 ? phase : phase + kPi;
        const Leg leg = legAt(own);
        const auto down = [](float angle) { return Vec3f(std::sin(angle), 0, -std::cos(angle)); };
        const Vec3f hip = hips + Vec3f(0, side * 0.050F * w, -0.01F * h);
        const Vec3f knee = hip + 0.245F * h * down(leg.hip) - Vec3f(0, side * 0.006F * h, 0);
        const Vec3f ankle = knee + 0.246F * h * down(leg.hip - leg.knee);
        addLeg(mesh, f, hip, knee, ankle, Vec3f(std::cos(leg.foot), 0, std::sin(leg.foot)));
        const float swing = -0.38F * std::sin(own), bend = 0.22F + 0.2F * std::max(0.F, swing);
        const Vec3f shoulder = onTrunk(f, hips, lean, 0.262F, side * (0.098F * w + 0.012F * h));
        const Vec3f elbow = shoulder + 0.172F * h * down(swing) + Vec3f(0, side * 0.022F * w, 0);
        const Vec3f hand = elbow + 0.150F * h * down(swing + bend) - Vec3f(0, side * 0.005F * h, 0);
        addArm(mesh, f, shoulder, elbow, hand);
    }
    addTrunk(mesh, f, hips, lean);
    addHead(mesh, f, onTrunk(f, hips, lean, 0.318F, 0), 0.02F, false);
    // The lower foot stands on the ground.
    float lowest = 0;
    for (const auto& p : mesh.vertices) lowest = std::min(lowest, p.z());
    for (auto& p : mesh.vertices) p.z() -= lowest;
    return mesh;
}

}  // namespace

std::vector<CarBody> centreInCommonBox(std::vector<Mesh> meshes) {
    Vec3f low = Vec3f::Constant(1e9F), high = -low;
    for (const auto& mesh : meshes) {
        for (const auto& p : mesh.vertices) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    low.z() = 0;
    const Vec3f centre = 0.5F * (low + high);
    std::vector<CarBody> shapes(meshes.size());
    for (std::size_t k = 0; k < meshes.size(); ++k) {
        CarBody& body = shapes[k];
        body.mesh = std::move(meshes[k]);
        for (auto& p : body.mesh.vertices) p -= centre;
        body.mesh.normals.resize(body.mesh.vertices.size(), Vec3f::Zero());
        body.outline.origin_obj = -centre;
        body.size_m = (high - low).cast<double>();
    }
    return shapes;
}

std::vector<CarBody> makePersonShapes(uint32_t seed, uint32_t phases) {
    std::vector<Mesh> meshes;
    for (uint32_t k = 0; k < phases; ++k)
        meshes.push_back(
            walkingMesh(seed, 6.2831853F * static_cast<float>(k) / static_cast<float>(phases)));
    return centreInCommonBox(std::move(meshes));
}

}  // namespace djpete::simulator
