/// What an HDL-64E does besides tracing rays: its beams, what the own car hides, echoes and noise.
#pragma once

#include <array>

#include "djpete/simulator/renderer.h"
#include "materials.h"

namespace djpete::simulator {

constexpr int kLidarBeams = 64;

/// Elevation of a beam, 0 the highest: two blocks, a third of a degree apart above, half a degree
/// below. Nominal; what calibration knows of a beam is in its points.
double nominalElevation_rad(int beam);

/// One of the 64; they are the same in every drive.
struct Laser {
    double elevation_rad = 0;  ///< uneven by 0.04 degrees, as in every scanner
    double bias_m = 0;         ///< what calibration leaves of its range offset
    float gain = 1;            ///< of the reflectance it states
};
Laser laserOf(int beam, const LidarOptions& options);

/// True if the own car's bonnet, roof rack or aerial stands in a beam's way. Azimuth
/// counter-clockwise from ahead, in [0, 2 pi). The sectors are those in which KITTI's scanner never
/// has a return.
bool hiddenByOwnCar(double azimuth_rad, double elevation_rad);

/// What comes back from a surface.
struct Echo {
    float reflectance = 0;  ///< as the scanner states it, before noise
    float strength = 0;     ///< a pulse is lost below 1
    float returns = 1;      ///< share of pulses that are not mirrored away or let through
};
/// `facing`: cosine between beam and normal. Weak echoes are stated darker than they are.
Echo echoOf(const SurfacePoint& point, const Shade& shade, float facing, float range_m);

/// Sigma of a range at a distance.
double rangeSigma_m(const LidarOptions& options, double range_m);

}  // namespace djpete::simulator
