/// A point of a car's surface in the terms of its outline.
#pragma once

#include "materials.h"

namespace djpete::simulator {

/// What of a car a point belongs to; where it changes there is an edge in the image.
enum CarPart : uint32_t {
    kPaint,
    kGlass,
    kTrim,
    kGrille,
    kHeadLight,
    kTailLight,
    kPlate,
    kRim,
    kGap,
    kMark,
    kBadge
};

struct OnCar {
    Vec3f p;          ///< in the frame of the outline, m: ground at z = 0
    float x, z;       ///< length fraction -0.5 .. 0.5, height fraction 0 .. 1
    float y;          ///< metres to the left
    float half;       ///< half of the width here, m
    float glassHalf;  ///< half of the greenhouse's width at this height, m
    bool side;        ///< faces left or right
};

OnCar locateOnCar(const SurfacePoint& s);

/// Seams, handles, mouldings, fuel flap.
void addSeams(const SurfacePoint& s, const OnCar& at, Shade& out);
/// Stripes, logos, letters, stickers.
void addMarkings(const SurfacePoint& s, const OnCar& at, Shade& out);
/// Letters on a panel: `x` to the right and `z` up from the row's middle, metres. How much of the
/// footprint is ink, 0..1.
float lettering(float x, float z, float height_m, float length_m, uint32_t seed, float footprint_m);

}  // namespace djpete::simulator
