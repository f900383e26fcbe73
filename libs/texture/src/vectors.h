/// Between the stored floats of a model and vectors.
#pragma once

#include <array>

#include "djpete/geometry/types.h"

namespace djpete::texture {

inline geometry::Vec3 vec3(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }
inline std::array<float, 3> floats(const geometry::Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace djpete::texture
