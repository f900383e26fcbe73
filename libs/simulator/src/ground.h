/// Roads, kerbs, pavements and lawns as triangles.
#pragma once

#include "mesh.h"
#include "network.h"

namespace djpete::simulator {

/// Adds the ground within Network::kReach_m of the streets, and a lawn to the horizon.
void addGround(Mesh& mesh, const Network& network, uint32_t seed);

}  // namespace djpete::simulator
