/// A measured cloud becomes an even surface. Private.
#pragma once

#include <vector>

#include "growing_model.h"

namespace djpete::texture {

/// Moves every point onto the plane of its neighbours (moving least squares), which takes out the
/// sensor's noise, and fills gaps: new points stand about `voxel_m` apart on these planes wherever
/// measured points are all around and sensors did not look through. At most `maxPoints` in all,
/// the moved ones first. Deterministic.
std::vector<SurfacePoint> refinedSurface(const std::vector<SurfacePoint>& points, double voxel_m,
                                         const FreeSpace& freeSpace, std::size_t maxPoints);

}  // namespace djpete::texture
