/// Points that belong to a surface of many points.
#pragma once

#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// Links points whose discs touch and whose normals agree (60 degrees). True for points of groups
/// of at least `minPoints`, or of a quarter of the largest group's points. `smallest_m`: discs
/// count as at least so large.
std::vector<bool> coherentPoints(const ObjectModel& model, std::size_t minPoints,
                                 double smallest_m);

}  // namespace djpete::texture
