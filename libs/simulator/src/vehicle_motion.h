/// The own vehicle between frames.
#pragma once

#include <cstdint>

#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// The own vehicle at `frame + share` frames, -1 <= share <= 1: on the screw motion between the
/// two frames around it; before frame 0 the motion from 0 to 1 goes on backwards.
geometry::SE3 vehicleBetween(const World& world, uint64_t frame, double share);

/// Twist (m/s, rad/s) of the own vehicle in its own frame: mean of the motions to the frame and
/// from it.
geometry::Vec6 vehicleTwist(const World& world, uint64_t frame);

}  // namespace djpete::simulator
