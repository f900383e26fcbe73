/// Trees and hedges made of single leaves.
#pragma once

#include "mesh.h"

namespace djpete::simulator {

/// How finely foliage is made: of leaves as they are, or of fewer and larger ones for far views.
enum class LeafDetail { Fine, Coarse };

/// A tree standing at the origin, about 5 to 7 m tall.
Mesh makeTree(uint32_t seed, LeafDetail detail = LeafDetail::Fine);
/// A clipped hedge of 2 m along x, 0.8 m deep and 1.5 m tall, standing at the origin.
Mesh makeHedge(uint32_t seed, LeafDetail detail = LeafDetail::Fine);

}  // namespace djpete::simulator
