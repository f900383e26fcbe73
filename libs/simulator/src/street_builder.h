/// Everything along the streets that never moves and is no car.
#pragma once

#include "mesh.h"
#include "network.h"

namespace djpete::simulator {

/// A mesh that stands at many places.
struct Plant {
    std::size_t prototype = 0;
    Vec3f foot = Vec3f::Zero();
    float yaw_rad = 0, scale = 1;
};

struct StreetModel {
    Mesh mesh;  ///< ground, kerbs, pavements, houses, walls, poles, in world coordinates
    std::vector<Mesh> prototypes, coarse;  ///< plants, and the same for far views
    std::vector<Plant> plants;
};

StreetModel buildStreet(const Network& network, uint32_t seed);

}  // namespace djpete::simulator
