/// What years do to roads, pavements and lawns, without a period along the street.
#pragma once

#include "texture_bank.h"

namespace djpete::simulator {

/// Albedo factor of a road by TextureBank::roadWear: cracks, sealed seams along it, patches.
/// `uv_m`: metres along and across a street; the seed tells streets apart. Stretches of a tile's
/// length are shifted and mirrored, each in its own way, and blend where they meet; seams run on.
float roadWearAt(const Vec2f& uv_m, float width_m, std::uint32_t seed);

/// The same of pavements, kerbs and lawns by TextureBank::stains.
float groundStainsAt(const Vec2f& uv_m, float width_m, std::uint32_t seed);

}  // namespace djpete::simulator
