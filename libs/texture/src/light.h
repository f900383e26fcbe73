/// Amounts of light, and the ground around an object that they are measured on. Private.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace djpete::texture {

using Light = std::array<double, 3>;  ///< red, green, blue, linear; 1: a camera's brightest value

inline double meanOf(const Light& light) { return (light[0] + light[1] + light[2]) / 3; }

/// Light of a colour of 0..255 that a camera coded with 255 light^(1 / gamma).
inline Light lightOf(const std::array<float, 3>& rgb, double gamma) {
    Light out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = std::pow(std::clamp(static_cast<double>(rgb[c]) / 255, 0.0, 1.0), gamma);
    }
    return out;
}

/// Directions of the compass: sector k holds azimuths [k, k + 1) * 30 degrees from the world's x
/// towards its y.
constexpr std::size_t kSectors = 12;
using GroundRing = std::array<std::optional<Light>, kSectors>;

}  // namespace djpete::texture
