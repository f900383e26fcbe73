/// Parametric cars.
#pragma once

#include "djpete/geometry/types.h"
#include "mesh.h"

namespace djpete::simulator {

constexpr uint32_t kCarBodyKinds = 6;  ///< hatchback, saloon, estate, SUV, van, coupe

/// Mesh in frame obj (box centre; x front, y left, z up) and the exact size of its box.
struct CarBody {
    Mesh mesh;
    geometry::Vec3 size_m{0, 0, 0};
    float wheelX_m = 0, wheelRadius_m = 0;
};

/// `kind` < kCarBodyKinds; the seed varies the size by a few percent.
CarBody makeCarBody(uint32_t kind, uint32_t seed);

}  // namespace djpete::simulator
