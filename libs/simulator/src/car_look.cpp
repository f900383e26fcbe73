#include "car_look.h"

#include <array>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

struct Paint {
    uint32_t share;  // of 100 cars
    Vec3f albedo;
};

/// The shares are those of new cars in Europe, rounded.
const std::array<Paint, 14>& paints() {
    static const std::array<Paint, 14> all{{{23, Vec3f(0.70F, 0.70F, 0.68F)},
                                            {9, Vec3f(0.065F, 0.07F, 0.078F)},
                                            {10, Vec3f(0.17F, 0.175F, 0.18F)},
                                            {17, Vec3f(0.016F, 0.016F, 0.018F)},
                                            {13, Vec3f(0.37F, 0.38F, 0.39F)},
                                            {6, Vec3f(0.018F, 0.05F, 0.20F)},
                                            {4, Vec3f(0.04F, 0.17F, 0.38F)},
                                            {6, Vec3f(0.42F, 0.022F, 0.018F)},
                                            {2, Vec3f(0.14F, 0.012F, 0.022F)},
                                            {3, Vec3f(0.28F, 0.23F, 0.16F)},
                                            {2, Vec3f(0.02F, 0.10F, 0.045F)},
                                            {2, Vec3f(0.60F, 0.40F, 0.02F)},
                                            {1, Vec3f(0.52F, 0.15F, 0.02F)},
                                            {2, Vec3f(0.22F, 0.36F, 0.34F)}}};
    return all;
}

}  // namespace

Vec3f carPaint(uint32_t seed) {
    uint32_t draw = hash(seed, 30U) % 100U;
    for (const auto& p : paints()) {
        if (draw < p.share) return between(hash(seed, 31U), 0.85F, 1.1F) * p.albedo;
        draw -= p.share;
    }
    return paints().front().albedo;
}

CarLook makeLook(uint32_t seed, bool commercial) {
    const auto chance = [seed](uint32_t what) { return unit(hash(seed, 500U, what)); };
    CarLook look;
    look.seed = seed;
    look.paint = carPaint(seed);
    if (commercial && chance(1) < 0.6F)
        look.paint = between(hash(seed, 32U), 0.62F, 0.74F) * Vec3f(1.F, 1.F, 0.97F);
    look.metallic = look.paint.maxCoeff() < 0.6F && chance(2) < 0.75F;
    look.roof = look.paint;
    if (!commercial && chance(3) < 0.13F)
        look.roof = Vec3f::Constant(look.paint.mean() < 0.2F ? 0.62F : 0.016F);
    // Markings stand out from the paint.
    static const std::array<Vec3f, 7> kInks{
        Vec3f(0.40F, 0.02F, 0.02F), Vec3f(0.02F, 0.07F, 0.30F),  Vec3f(0.02F, 0.20F, 0.06F),
        Vec3f(0.60F, 0.38F, 0.02F), Vec3f(0.50F, 0.14F, 0.015F), Vec3f(0.02F, 0.02F, 0.022F),
        Vec3f(0.72F, 0.72F, 0.70F)};
    look.ink = kInks.at(hash(seed, 501U) % kInks.size());
    if ((look.ink - look.paint).cwiseAbs().maxCoeff() < 0.15F)
        look.ink = Vec3f::Constant(look.paint.mean() < 0.25F ? 0.70F : 0.02F);
    const float dirt = chance(4);
    look.dirt = dirt * dirt * (commercial ? 1.F : 0.85F);
    look.plasticArches = chance(5) < 0.25F;
    look.moulding = chance(6) < 0.35F;
    look.darkGlass = chance(7) < 0.35F;
    look.chrome = chance(8) < 0.35F;
    look.hub = hash(seed, 502U) % 6U;
    look.lamp = hash(seed, 503U) % 3U;
    look.rack = chance(9) < 0.45F;
    if (chance(10) < 0.05F) look.oddPanel = static_cast<int>(hash(seed, 504U) % 2U);
    const float m = chance(11);
    using Marking = CarLook::Marking;
    if (commercial) {
        look.marking = m < 0.18F ? Marking::None : m < 0.55F ? Marking::Letters : Marking::Flank;
    } else {
        look.marking = m < 0.05F   ? Marking::RacingStripes
                       : m < 0.12F ? Marking::SideStripe
                       : m < 0.19F ? Marking::DoorLogo
                       : m < 0.22F ? Marking::Flank
                                   : Marking::None;
    }
    return look;
}

bool letterAt(float x, float z, uint32_t seed) {
    // Blocks of 3 x 5, row by row from the top: letters and digits that can be told apart.
    static const std::array<uint16_t, 20> kGlyphs{
        0b111101111101101, 0b110101110101110, 0b011100100100011, 0b110101101101110,
        0b111100110100111, 0b111100110100100, 0b101101111101101, 0b111010010010111,
        0b100100100100111, 0b101111111101101, 0b010101101101010, 0b110101110100100,
        0b110101110110101, 0b111010010010010, 0b101101101101111, 0b111101101101111,
        0b010110010010111, 0b110001010100111, 0b111001011001111, 0b101101111001001};
    if (std::abs(z) >= 0.5F) return false;
    const float column = x / kLetterPitch;
    const float inside = (column - std::floor(column)) * kLetterPitch / 0.58F;
    if (inside >= 1.F) return false;
    const uint32_t letter = hash(cellOf(column), seed) % (kGlyphs.size() + 2U);
    if (letter >= kGlyphs.size()) return false;  // a gap between words
    const auto row = static_cast<uint32_t>((0.5F - z) * 5.F);
    const auto col = static_cast<uint32_t>(inside * 3.F);
    return ((kGlyphs.at(letter) >> (14U - 3U * row - col)) & 1U) != 0U;
}

}  // namespace djpete::simulator
