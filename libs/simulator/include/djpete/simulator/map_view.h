/// A look at the whole district from above.
#pragma once

#include "djpete/simulator/renderer.h"

namespace djpete::simulator {

/// The streets of a drive as a camera high above sees them at a frame, north (the world's y) up, at
/// most `side_px` wide and high.
RenderedImage renderMap(Renderer& renderer, const World& world, uint64_t frame, int side_px);

}  // namespace djpete::simulator
