/// What an object looks like, in few numbers.
#pragma once

#include <array>
#include <cstdint>

namespace djpete::obs {

/// A histogram of an object's pixels: 8 bins of hue for coloured pixels, weighed by how colourful
/// they are, then 8 of brightness relative to the object's own mean, then 8 of brightness as it is.
/// Grey images leave the hues empty. Each of the three groups sums to at most 255.
using Appearance = std::array<uint8_t, 24>;

/// 0 (the same) to 1 (nothing in common): Hellinger distance, mean over the groups that both have.
/// Absolute brightness counts half, for it changes with exposure.
double appearanceDistance(const Appearance& a, const Appearance& b);

}  // namespace djpete::obs
