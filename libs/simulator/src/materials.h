/// What a surface looks like where a ray meets it.
#pragma once

#include "mesh.h"

namespace djpete::simulator {

/// Where a ray met a surface.
struct SurfacePoint {
    Material material = Material::Grass;
    uint32_t seed = 0;
    Vec2f uv = Vec2f::Zero();        ///< metres on the surface
    Vec3f p_obj = Vec3f::Zero();     ///< in the frame of the thing (cars: frame obj)
    Vec3f n_obj = Vec3f::UnitZ();    ///< normal in that frame, towards the viewer
    Vec3f halfSize = Vec3f::Zero();  ///< cars: half of the box
    float wheelX_m = 0, wheelRadius_m = 0;
    float footprint_m = 0.01F;  ///< size of the pixel on the surface
};

struct Shade {
    Vec3f albedo = Vec3f::Constant(0.5F);  ///< red, green, blue, 0..1
    float gloss = 0;                       ///< share of mirrored sky
    float reflectance = 0.3F;              ///< for the LiDAR, 0..1
};

/// A pure function of the point: world-anchored, so that every view sees the same texture.
Shade shade(const SurfacePoint& s);

/// Paint of the car with this seed.
Vec3f carPaint(uint32_t seed);

/// Sky seen in a direction (z up).
Vec3f sky(const Vec3f& direction);

}  // namespace djpete::simulator
