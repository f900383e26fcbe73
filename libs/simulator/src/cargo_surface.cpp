#include <algorithm>
#include <cmath>

#include "car_place.h"
#include "noise.h"

namespace djpete::simulator {

/// A company's large letters and a colour field, panel joints, streaks of rain and road dust.
Shade cargoSurface(const SurfacePoint& s) {
    const CarLook& look = s.car->look;
    const Vec3f size = s.car->size_m.cast<float>();
    const float u = s.uv.x(), v = s.uv.y();
    const bool flank = std::abs(s.n_obj.y()) > 0.6F, door = s.n_obj.x() < -0.6F;
    const float high = size.z() - 0.95F;
    Shade out;
    out.albedo = look.paint.mean() > 0.3F ? look.paint : Vec3f(0.66F, 0.66F, 0.64F);
    const float style = unit(hash(look.seed, 530U));
    const float field = style < 0.3F   ? 0.30F * high
                        : style < 0.6F ? 0.15F * high + 0.22F * u
                        : style < 0.8F ? high * (0.25F + 0.1F * std::sin(1.1F * u + 5.F * style))
                                       : -1.F;
    if (flank && v < field) out.albedo = look.ink, out.part = kMark;
    if (flank && look.marking != CarLook::Marking::None) {
        const float tall = between(hash(look.seed, 531U), 0.45F, 0.75F);
        const float row =
            lettering(u - 2.5F, v - 0.66F * high, tall, 4.2F, look.seed + 1U, s.footprint_m);
        const float below = lettering(u - 2.3F, v - 0.66F * high + 0.85F * tall, 0.3F * tall, 3.2F,
                                      look.seed + 2U, s.footprint_m);
        const float ink = std::max(row, below);
        const Vec3f letters = v < field ? Vec3f(0.70F, 0.70F, 0.68F) : look.ink;
        out.albedo += ink * (letters - out.albedo);
        if (ink > 0.5F) out.part = kMark;
    }
    const float seam = std::max(0.007F, 0.5F * s.footprint_m);
    const float depth = 0.7F * std::min(1.F, 0.014F / (2.F * seam));
    const float panel = door ? u - 0.5F * (size.y() - 0.02F) : u / 1.2F - std::round(u / 1.2F);
    if (std::abs(panel) * (door ? 1.F : 1.2F) < seam) out.albedo *= 1.F - depth, out.part = kGap;
    if (door) {
        const float bar = std::abs(std::abs(panel) - 0.28F);  // locking bars
        if (bar < 0.022F) out.albedo = Vec3f::Constant(0.30F), out.part = kTrim;
        const float ink = lettering(u - 0.5F * size.y(), v - 0.62F * high, 0.2F, 1.5F,
                                    look.seed + 1U, s.footprint_m);
        out.albedo += ink * (look.ink - out.albedo);
        // Slanted red and white warning stripes.
        if (v < 0.16F)
            out.albedo = std::sin(20.F * (u + (u < 0.5F * size.y() ? v : -v))) > 0
                             ? Vec3f(0.42F, 0.02F, 0.02F)
                             : Vec3f(0.66F, 0.66F, 0.64F),
            out.part = kMark;
    }
    const Texture& stains = TextureBank::shared().stains();
    const Vec2f off(13.F * unit(look.seed), 0);
    const float cloud = stains.sampleRound(6.F * s.uv + off, 6.F * s.footprint_m).x();
    const float streaks =
        stains.sampleRound(Vec2f(30.F * u, 1.5F * v) + off, 15.F * s.footprint_m).x();
    const float wear = 0.12F + 0.3F * look.dirt;
    out.albedo *= 1.F + wear * (0.5F * (cloud + streaks) - 1.F);
    const float dust = std::clamp((0.15F + 0.4F * look.dirt) * (0.9F - v) * cloud, 0.F, 0.6F);
    out.albedo += dust * (Vec3f(0.15F, 0.135F, 0.11F) - out.albedo);
    out.gloss = 0.015F;
    out.reflectance = std::clamp(0.08F + 0.8F * out.albedo.mean(), 0.F, 0.95F);
    return out;
}

}  // namespace djpete::simulator
