/// Edits of points. Private.
#pragma once

#include "djpete/texture/region.h"

namespace djpete::texture {

/// Points that stand alone go (mean distance to eight neighbours above the mean of all by 2.5
/// standard deviations); colours of at most two views that are far from those around them become
/// the neighbours' median. In the region only.
void denoise(ObjectModel& model, const Region& region);

}  // namespace djpete::texture
