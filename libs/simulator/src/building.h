/// Houses with windows that lie back in the wall, sills, shutters, doors and gabled roofs.
#pragma once

#include "mesh.h"

namespace djpete::simulator {

/// A house in the plane of its front: x along the front (0 .. width), y outwards, z up.
struct Plot {
    Vec3f origin = Vec3f::Zero();  ///< left foot of the front, seen from the street's side
    Vec3f x = Vec3f::UnitX(), y = Vec3f::UnitY();
    float width_m = 10, depth_m = 9;
    Vec3f at(float along, float out, float up) const {
        return origin + along * x + out * y + Vec3f(0, 0, up);
    }
};

void addHouse(Mesh& mesh, const Plot& plot, uint32_t seed);

}  // namespace djpete::simulator
