/// Edits of colours. Private.
#pragma once

#include "djpete/texture/region.h"

namespace djpete::texture {

/// Coloured points get the colour, brighter or darker as they are now against the region's median.
void recolour(ObjectModel& model, const std::array<float, 3>& rgb, const Region& region);
/// All points of the region get the colour.
void brush(ObjectModel& model, const std::array<float, 3>& rgb, const Region& region);
/// Bilateral mean over neighbours within `reach_m`.
void smoothColours(ObjectModel& model, double reach_m, const Region& region);
/// Colours of the nearest point of `other` with a like normal, boxes scaled onto each other.
void replaceColours(ObjectModel& model, const ObjectModel& other, const Region& region);

}  // namespace djpete::texture
