/// Sun and sky of a drive, from the ground around its objects and from their own surfaces. Private.
#pragma once

#include <vector>

#include "djpete/geometry/types.h"
#include "light.h"

namespace djpete::texture {

/// Light that the ground sends back, and where the sun stands.
struct Daylight {
    bool sun = false;                      ///< the ground is bright here and dark there
    Light sunny{1, 1, 1}, shady{1, 1, 1};  ///< level ground in the sun and in shadow
    geometry::Vec3 sun_world{0, 0, 1};     ///< unit, towards it
    double border() const;                 ///< mean light between shady and sunny
};

/// Levels of the ground without the sun's direction; nothing if no ring has a sector.
std::optional<Daylight> groundLevels(const std::vector<GroundRing>& rings);

/// What a surface of albedo 1 would send back if the sun reached it, or did not, and what a glossy
/// one adds by mirroring the sky. Ground of albedo kRoadAlbedo is the grey card that the light was
/// measured on.
struct Illumination {
    Light inSun, inShade, mirrored;
    bool facesSun = false;
};

/// Worn asphalt. If it is another one, all albedos of the drive are wrong by one factor.
constexpr double kRoadAlbedo = 0.13;

/// `towards_world`: unit vector from the point to the camera.
Illumination illuminationOf(const Daylight& day, const geometry::Vec3& normal_world,
                            const geometry::Vec3& towards_world);

/// How likely the sun reaches the object, 0.1..0.9, by the ground on its sunny side.
double chanceOfSun(const Daylight& day, const GroundRing& ring);
/// How much brighter the ground around one object is than the drive's, in the same light: errors of
/// exposure between parts of the drive.
double localScale(const Daylight& day, const GroundRing& ring);

}  // namespace djpete::texture
