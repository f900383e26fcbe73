/// Everything along the street that never moves and is no car.
#pragma once

#include "djpete/simulator/street.h"
#include "mesh.h"

namespace djpete::simulator {

constexpr double kRoadHalfWidth_m = 5.3;

/// A mesh that stands at many places.
struct Plant {
    std::size_t prototype = 0;
    Vec3f foot = Vec3f::Zero();
    float yaw_rad = 0, scale = 1;
};

struct StreetModel {
    Mesh mesh;  ///< ground, kerbs, pavements, houses, walls, poles, in world coordinates
    std::vector<Mesh> prototypes;
    std::vector<Plant> plants;
};

StreetModel buildStreet(const Street& street, uint32_t seed);

}  // namespace djpete::simulator
