/// An exposure that is driven up and down, as by sun and shade in turn. Private.
#pragma once

#include <cstdint>

namespace djpete::simulator {

/// By what the exposure of a frame is multiplied: between 1 / (1 + amount) and 1 + amount, up and
/// down by turns of 12 frames. Most turns are smooth; one in three is over within three frames.
/// Depends on seed and frame only; 1 for amount 0.
double exposureSwing(uint32_t seed, uint64_t frame, double amount);

}  // namespace djpete::simulator
