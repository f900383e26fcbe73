/// Which points cannot be of an object's outside.
#pragma once

#include <cmath>

#include "djpete/geometry/types.h"

namespace djpete::texture {

/// True for a point of the left half that faces right, or the other way round: the inside of a
/// panel, seen through a window, or a wrong normal. Frame obj.
inline bool facesInwards(const geometry::Vec3& p_obj, const geometry::Vec3& normal_obj) {
    return std::abs(normal_obj.y()) > 0.5 && normal_obj.y() * p_obj.y() < 0;
}

}  // namespace djpete::texture
