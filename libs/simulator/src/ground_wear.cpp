#include "ground_wear.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {
namespace {

constexpr float kBlend_m = 1.5F;  // where two stretches meet

/// One stretch's look at a tiling texture: a mirror along, a mirror across and a shift of both.
/// Across it shifts by whole `lane_m`, and mirrors about 0, so that what runs along stays in place.
float stretchAt(const Texture& texture, const Vec2f& uv_m, float width_m, float tile_m,
                float lane_m, std::uint32_t look) {
    const float along = (look & 1U) != 0U ? -uv_m.x() : uv_m.x();
    const float across = (look & 2U) != 0U ? -uv_m.y() : uv_m.y();
    const auto lanes = static_cast<std::uint32_t>(tile_m / lane_m + 0.5F);
    const Vec2f shift(tile_m * unit(look), lane_m * static_cast<float>((look >> 2) % lanes));
    return texture.sampleRound(Vec2f(along, across) + shift, width_m).x();
}

float aperiodic(const Texture& texture, const Vec2f& uv_m, float width_m, float tile_m,
                float lane_m, std::uint32_t seed) {
    const float cell = std::floor(uv_m.x() / tile_m), in_m = uv_m.x() - cell * tile_m;
    const auto index = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell));
    // Coordinates within the stretch keep their precision on long streets.
    const Vec2f here(in_m, uv_m.y());
    const float own = stretchAt(texture, here, width_m, tile_m, lane_m, hash(index, seed));
    const float border_m = std::min(in_m, tile_m - in_m);
    if (border_m >= 0.5F * kBlend_m) return own;
    const bool before = in_m < 0.5F * tile_m;
    const Vec2f beyond(before ? in_m + tile_m : in_m - tile_m, uv_m.y());
    const float next = stretchAt(texture, beyond, width_m, tile_m, lane_m,
                                 hash(before ? index - 1U : index + 1U, seed));
    const float t = 0.5F + border_m / kBlend_m;
    const float mine = t * t * (3.F - 2.F * t);
    return next + mine * (own - next);
}

}  // namespace

float roadWearAt(const Vec2f& uv_m, float width_m, std::uint32_t seed) {
    const TextureBank& bank = TextureBank::shared();
    // Each street has its seams elsewhere, and they wander a little.
    const float across = uv_m.y() + 4.F * unit(hash(seed, 2U)) + bank.seamBend_m(uv_m.x(), seed);
    return aperiodic(bank.roadWear(), Vec2f(uv_m.x(), across), width_m, TextureBank::kWear_m,
                     TextureBank::kSeam_m, seed);
}

float groundStainsAt(const Vec2f& uv_m, float width_m, std::uint32_t seed) {
    // Nothing runs along here, so any shift across will do.
    constexpr float kAnywhere = TextureBank::kStains_m / 64.F;
    return aperiodic(TextureBank::shared().stains(), uv_m, width_m, TextureBank::kStains_m,
                     kAnywhere, seed);
}

}  // namespace djpete::simulator
