/// Parametric cars.
#pragma once

#include "djpete/geometry/types.h"
#include "mesh.h"

namespace djpete::simulator {

/// hatchback, saloon, estate, SUV, van, small city car, pick-up
constexpr uint32_t kCarBodyKinds = 7;
constexpr uint32_t kVan = 4;

/// Side view of a car; x over the length (-0.5 rear .. 0.5 front), z over the height (0 .. 1).
struct CarOutline {
    float length_m = 0, width_m = 0, height_m = 0;
    std::vector<Vec2f> top;          ///< upper line from rear to front
    float belt = 0.6F;               ///< lower edge of the side windows
    float sideRear = -0.4F;          ///< side windows begin here
    float pillar = 0, pillar2 = -1;  ///< x of the pillars between side windows; -1: none
    float cowl = 0.26F;              ///< foot of the windscreen
    float rearFoot = -0.48F, rearHead = -0.38F;  ///< rear window from .. to
    float sideFront = 0.5F;                      ///< side windows end here at the latest
    float wheelFront = 0.32F, wheelRear = -0.29F, wheelRadius_m = 0.31F, clearance_m = 0.19F;

    float topAt(float x) const;
    /// Half of the width at the belt for this x, in metres.
    float halfWidthAt(float x) const;
};

/// Mesh in frame obj (box centre; x front, y left, z up) and the exact size of its box.
struct CarBody {
    Mesh mesh;
    CarOutline outline;
    geometry::Vec3 size_m{0, 0, 0};
};

/// `kind` < kCarBodyKinds; the seed varies the size by a few percent.
CarBody makeCarBody(uint32_t kind, uint32_t seed);

}  // namespace djpete::simulator
