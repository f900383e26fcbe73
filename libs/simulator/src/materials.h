/// What a surface looks like where a ray meets it.
#pragma once

#include "car_body.h"
#include "texture_bank.h"

namespace djpete::simulator {

/// Where a ray met a surface.
struct SurfacePoint {
    Finish finish;
    Vec2f uv = Vec2f::Zero();       ///< metres on the surface
    Vec3f p_obj = Vec3f::Zero();    ///< in the frame of the thing (cars: frame obj)
    Vec3f n_obj = Vec3f::UnitZ();   ///< normal in that frame, towards the viewer
    const CarBody* car = nullptr;   ///< of cars
    Vec2f major_m = Vec2f::Zero();  ///< long axis of the pixel's footprint, in uv
    float footprint_m = 0.01F;      ///< its short axis
};

struct Shade {
    Vec3f albedo = Vec3f::Constant(0.5F);  ///< red, green, blue, linear, 0..1
    float gloss = 0;                       ///< share of mirrored surroundings, face on
    float reflectance = 0.3F;              ///< for the LiDAR, 0..1
    float returns = 1;                     ///< share of LiDAR pulses that come back
    /// The sun reaches in this deep; shadows of what is nearer (the next leaf) do not show.
    float depth_m = 0.01F;
    uint32_t part = 0;  ///< changes at painted edges
};

/// A pure function of the point: world-anchored, so that every view sees the same texture.
Shade shade(const SurfacePoint& s);

/// The same for a car's body and wheels: windows, doors, lights, plates by position.
Shade carSurface(const SurfacePoint& s);
Shade wheelSurface(const SurfacePoint& s);
/// The box of a truck.
Shade cargoSurface(const SurfacePoint& s);

/// Clothes, skin, hair, shoes and bicycles.
Shade personSurface(const SurfacePoint& s);
Shade cycleSurface(const SurfacePoint& s);

/// Radiance of the sky in a direction (z up), with clouds and a skyline far away.
Vec3f sky(const Vec3f& direction);
/// What a window mirrors in a direction: sky, house fronts, ground. Smooth.
Vec3f mirrored(const Vec3f& direction);

}  // namespace djpete::simulator
