/// Parametric cars and vans.
#pragma once

#include "car_look.h"
#include "djpete/geometry/types.h"
#include "mesh.h"

namespace djpete::simulator {

/// hatchback, saloon, estate, SUV, panel van, small city car, pick-up, minibus, people carrier,
/// tall panel van
constexpr uint32_t kCarBodyKinds = 10;
constexpr uint32_t kVan = 4, kPickUp = 6, kMinibus = 7, kTallVan = 9;

/// Side view of a car; x over the length (-0.5 rear .. 0.5 front), z over the height (0 .. 1).
struct CarOutline {
    float length_m = 0, width_m = 0, height_m = 0;
    std::vector<Vec2f> top;          ///< upper line from rear to front
    float belt = 0.6F;               ///< lower edge of the side windows
    float sideRear = -0.4F;          ///< side windows begin here
    float pillar = 0, pillar2 = -1;  ///< x of the pillars between side windows; -1: none
    float cowl = 0.26F;              ///< foot of the windscreen
    float rearFoot = -0.48F, rearHead = -0.38F;  ///< rear window from .. to
    float wheelFront = 0.32F, wheelRear = -0.29F, wheelRadius_m = 0.31F, clearance_m = 0.19F;
    float lean = 0.30F;                ///< how far the sides lean in above the belt, per metre
    bool cab = false;                  ///< of a truck: nothing but doors behind the windscreen
    bool van = false;                  ///< sheet metal behind the front doors
    Vec3f origin_obj = Vec3f::Zero();  ///< of the outline: on the ground, mid-length, mid-width

    float archRadius_m() const { return wheelRadius_m + 0.055F; }
    float topAt(float x) const;
    /// Half of the width at the belt for this x, in metres.
    float halfWidthAt(float x) const;
    /// The lower edge of the side at this x, in metres above the ground: wheel arches cut into it.
    float lowAt(float x) const;
};

/// `kind` < kCarBodyKinds; the seed varies the sizes by a few percent. `origin_obj` is zero.
CarOutline makeOutline(uint32_t kind, uint32_t seed);

/// Mesh in frame obj (box centre; x front, y left, z up) and the exact size of its box.
struct CarBody {
    Mesh mesh;
    CarOutline outline;
    CarLook look;
    geometry::Vec3 size_m{0, 0, 0};
};

CarBody makeCarBody(uint32_t kind, uint32_t seed);

/// Parts, in the frame of the outline; the mesh is centred when all of them are there.
void addShell(Mesh& mesh, const CarOutline& o, uint32_t finish);
void addWheels(Mesh& mesh, const CarOutline& o, uint32_t seed);
void addMirrors(Mesh& mesh, const CarOutline& o, uint32_t paint);
void addRoofRack(Mesh& mesh, const CarOutline& o, uint32_t finish);
/// Moves the body so that the box of its vertices is centred; sets its size and origin_obj.
void centreOnBox(CarBody& body);

}  // namespace djpete::simulator
