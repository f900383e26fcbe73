/// Trees and hedges made of single leaves.
#pragma once

#include "mesh.h"

namespace djpete::simulator {

/// A tree standing at the origin, about 5 to 7 m tall.
Mesh makeTree(uint32_t seed);
/// A clipped hedge of 2 m along x, 0.8 m deep and 1.5 m tall, standing at the origin.
Mesh makeHedge(uint32_t seed);

}  // namespace djpete::simulator
