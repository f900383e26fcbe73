#include "truck_body.h"

#include <algorithm>

#include "noise.h"

namespace djpete::simulator {
namespace {

constexpr float kBed_m = 0.95F;  // the box stands here

CarOutline cabOutline(uint32_t seed) {
    CarOutline o;
    o.length_m = between(hash(seed, 11), 1.85F, 2.05F);
    o.width_m = between(hash(seed, 12), 2.12F, 2.25F);
    o.height_m = between(hash(seed, 13), 2.30F, 2.55F);
    o.top = {{-.5F, .93F}, {-.47F, .985F}, {-.2F, 1.F},   {.1F, .99F}, {.24F, .955F},
             {.43F, .56F}, {.465F, .50F},  {.492F, .40F}, {.5F, .22F}};
    o.belt = .50F, o.sideRear = -.18F, o.pillar = -1.F, o.cowl = .43F;
    o.rearFoot = -2.F, o.rearHead = -2.F;  // no rear window
    o.wheelFront = .05F, o.wheelRear = -9.F, o.wheelRadius_m = between(hash(seed, 14), .40F, .44F);
    o.clearance_m = .33F, o.lean = .06F, o.van = o.cab = true;
    return o;
}

/// Walls, door and roof of the box with rails along its edges; uv of each wall is in metres from
/// its lower left corner seen from outside.
void addBoxBody(Mesh& mesh, float rear, float front, float width, float height, uint32_t seed) {
    const uint32_t panels = mesh.addFinish(Material::Cargo, Vec3f::Ones(), seed);
    const float tone = unit(hash(seed, 15U)) < 0.6F ? 0.32F : 0.06F;
    const uint32_t rail = mesh.addFinish(Material::Metal, Vec3f::Constant(tone), seed);
    const float length = front - rear, middle = 0.5F * (front + rear);
    mesh.addBox(Vec3f(middle, 0, kBed_m), Vec3f(length, width, height - kBed_m), Vec3f::UnitX(),
                panels);
    // Corners and edges stand out by a centimetre.
    const float thick = 0.07F, out = 0.01F, hy = 0.5F * width;
    for (float side : {-1.F, 1.F}) {
        for (float z : {kBed_m - 0.02F, height - thick + out})
            mesh.addBox(Vec3f(middle, side * (hy - 0.5F * thick + out), z),
                        Vec3f(length + 2 * out, thick, thick), Vec3f::UnitX(), rail);
        for (float x : {rear, front})
            mesh.addBox(Vec3f(x + (x == rear ? 0.5F * thick - out : out - 0.5F * thick),
                              side * (hy - 0.5F * thick + out), kBed_m),
                        Vec3f(thick, thick, height - kBed_m), Vec3f::UnitX(), rail);
    }
}

/// Frame, tank, side guards and rear bumper with its lights and plate.
void addChassis(Mesh& mesh, float rear, float front, float width, float wheelRear, uint32_t seed) {
    const uint32_t dark = mesh.addFinish(Material::Metal, Vec3f::Constant(0.025F), seed);
    const uint32_t bright = mesh.addFinish(Material::Metal, Vec3f::Constant(0.33F), seed);
    mesh.addBox(Vec3f(0.5F * (rear + front), 0, 0.55F), Vec3f(front - rear - 0.1F, 0.9F, 0.4F),
                Vec3f::UnitX(), dark);
    mesh.addBox(Vec3f(rear + 0.12F, 0, 0.48F), Vec3f(0.12F, width - 0.1F, 0.14F), Vec3f::UnitX(),
                dark);
    const float space = wheelRear + 0.65F;
    for (float side : {-1.F, 1.F}) {
        const bool tank = (unit(hash(seed, 16U)) < 0.5F) == (side > 0);
        if (tank)
            mesh.addBox(Vec3f(front - 0.75F, side * (0.5F * width - 0.35F), 0.45F),
                        Vec3f(0.95F, 0.5F, 0.46F), Vec3f::UnitX(), bright);
        const float from = space, to = tank ? front - 1.35F : front - 0.3F;
        for (float z : {0.50F, 0.72F}) {
            if (to - from > 0.3F)
                mesh.addBox(Vec3f(0.5F * (from + to), side * (0.5F * width - 0.1F), z),
                            Vec3f(to - from, 0.03F, 0.10F), Vec3f::UnitX(), bright);
        }
        const uint32_t lamp = mesh.addFinish(Material::Sign, Vec3f(0.42F, 0.02F, 0.02F), seed);
        mesh.addBox(Vec3f(rear + 0.08F, side * (0.5F * width - 0.32F), 0.62F),
                    Vec3f(0.06F, 0.42F, 0.14F), Vec3f::UnitX(), lamp);
    }
}

}  // namespace

CarBody makeTruckBody(uint32_t seed) {
    CarBody body;
    CarOutline& cab = body.outline;
    cab = cabOutline(seed);
    body.look = makeLook(seed, true);
    body.look.hub = 3;
    const float box = between(hash(seed, 17), 4.7F, 6.2F),
                width = between(hash(seed, 18), 2.3F, 2.5F),
                height = between(hash(seed, 19), 2.95F, 3.35F);
    Mesh& mesh = body.mesh;
    addShell(mesh, cab, mesh.addFinish(Material::CarBody, Vec3f::Ones(), seed));
    addMirrors(mesh, cab, mesh.addFinish(Material::Metal, Vec3f::Constant(0.03F), seed));
    const float front = -0.5F * cab.length_m - 0.09F, rear = front - box;
    const float wheelRear = rear + between(hash(seed, 20), 0.26F, 0.32F) * box;
    addBoxBody(mesh, rear, front, width, height, seed);
    addChassis(mesh, rear, front, width, wheelRear, seed);
    // The wheels of both axles, in the outline's fractions.
    CarOutline wheels = cab;
    wheels.wheelRear = wheelRear / cab.length_m;
    wheels.width_m = std::min(width, cab.width_m + 0.05F);
    addWheels(mesh, wheels, seed);
    centreOnBox(body);
    return body;
}

}  // namespace djpete::simulator
