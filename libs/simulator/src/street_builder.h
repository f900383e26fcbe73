/// Everything along the street that never moves and is no car.
#pragma once

#include "djpete/simulator/street.h"
#include "mesh.h"

namespace djpete::simulator {

constexpr double kRoadHalfWidth_m = 5.3;

/// Ground, kerbs, pavements, facades, trees, hedges and poles, in world coordinates.
Mesh buildStreet(const Street& street, uint32_t seed);

}  // namespace djpete::simulator
