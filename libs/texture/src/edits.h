/// The single edits; see editing.h. `in`: the region's points. Each changes `model` and counts.
#pragma once

#include <string>
#include <vector>

#include "djpete/texture/editing.h"
#include "djpete/texture/region.h"

namespace djpete::texture {

using Mask = std::vector<bool>;

void recolour(ObjectModel& model, const Mask& in, const std::array<float, 3>& rgb,
              EditReport& report);
void brush(ObjectModel& model, const Mask& in, const std::array<float, 3>& rgb, EditReport& report);
void smoothColours(ObjectModel& model, const Mask& in, unsigned passes, EditReport& report);
void crop(ObjectModel& model, const Mask& in, bool keep, EditReport& report);
void denoise(ObjectModel& model, const Mask& in, double sigmas, EditReport& report);
void replaceColours(ObjectModel& model, const Mask& in, const ObjectModel& other,
                    EditReport& report);
void symmetriseWithin(ObjectModel& model, const Mask& in, const Region& region, EditReport& report);
void fillWithin(ObjectModel& model, const Mask& in, EditReport& report);

/// Gives a point the colour that an edit chose.
void setColour(ObjectModel& model, std::size_t point, const std::array<float, 3>& rgb);

}  // namespace djpete::texture
