/// Where an object's surface may be that nobody saw.
#pragma once

#include "distance_grid.h"

namespace djpete::texture {

/// Gives every corner of the grid that no point is near a distance that goes over smoothly from the
/// known ones into those of a plain body: the silhouette of the points seen from the side, as wide
/// as the box, without what rays passed. The grid must reach beyond the box. The zero set is
/// closed afterwards.
void closeGaps(DistanceGrid& grid, const ObjectModel& model);

}  // namespace djpete::texture
