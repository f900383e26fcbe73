#include <algorithm>
#include <cmath>

#include "car_place.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

float fract(float x) { return x - std::floor(x); }

/// Prints on clothes by their seed; `u` is 0 at the chest's middle.
Vec3f printed(const SurfacePoint& s, const Vec3f& base) {
    if (s.finish.seed % 2U == 1U) return base;  // trousers
    const bool trunk = s.finish.seed % 4U == 0U;
    const uint32_t seed = s.finish.seed & ~3U;  // sleeves go with the trunk
    const float u = s.uv.x(), v = s.uv.y(), style = unit(hash(seed, 700U));
    Vec3f ink = carPaint(hash(seed, 701U));
    if ((ink - base).cwiseAbs().maxCoeff() < 0.1F)
        ink = Vec3f::Constant(base.mean() < 0.25F ? 0.6F : 0.03F);
    const float wave = between(hash(seed, 702U), 0.035F, 0.09F);
    const float seen = visible(wave, s.footprint_m);
    const auto over = [&](float share, bool on) {
        return Vec3f(base + (seen * (on ? 1.F : 0.F) + (1.F - seen) * share) * (ink - base));
    };
    if (style < 0.16F) return over(0.4F, fract(v / wave) < 0.4F);
    if (style < 0.22F) return over(0.35F, fract(u / wave) < 0.35F);
    if (style < 0.32F) {
        const bool a = fract(u / wave) < 0.4F, b = fract(v / wave) < 0.4F;
        return base + (0.5F * (a ? 1.F : 0.F) + 0.5F * (b ? 1.F : 0.F)) * seen * (ink - base);
    }
    if (!trunk) return base;
    if (style < 0.46F) {  // a word on the chest
        const float ink01 = lettering(u, v - 0.33F, 0.07F, 0.26F, seed, s.footprint_m);
        return base + ink01 * (ink - base);
    }
    if (style < 0.56F) {  // a picture on the chest and one on the back
        const float r = std::hypot(u, v - 0.32F) / 0.10F;
        const bool spot = r < 1.F && std::cos(5.F * std::atan2(v - 0.32F, u)) > r - 0.6F;
        return spot ? ink : base;
    }
    if (style < 0.66F) return v > 0.34F ? ink : base;  // a yoke
    if (style < 0.74F) return std::abs(v - 0.27F) < 0.04F ? ink : base;
    if (style < 0.90F && std::abs(u) < 0.012F) return 0.35F * base;  // a zip
    return base;
}

Shade cloth(const SurfacePoint& s) {
    Shade out;
    out.albedo = printed(s, s.finish.tint);
    const float shift = 9.F * unit(s.finish.seed);
    const auto folds = [&](float scale) {
        return TextureBank::shared()
            .stains()
            .sampleRound(scale * s.uv + Vec2f(shift, 0), scale * s.footprint_m)
            .x();
    };
    out.albedo *=
        std::clamp(1.F + 0.55F * (folds(14.F) - 1.F) + 0.35F * (folds(45.F) - 1.F), 0.3F, 1.6F);
    out.reflectance = std::clamp(0.1F + 0.9F * out.albedo.mean(), 0.F, 0.9F);
    return out;
}

/// Eyes, brows, mouth and ears by position; the nose's tip is at u = 0.
Shade face(const SurfacePoint& s) {
    Shade out;
    out.albedo = s.finish.tint;
    out.reflectance = 0.4F;
    if (s.finish.seed == 0) return out;
    const float u = std::abs(s.uv.x()), v = s.uv.y();  // v from the chin, about 0.23 m long
    if (std::hypot(u - 0.036F, (v - 0.122F) * 1.8F) < 0.011F) out.albedo *= 0.15F, out.part = 1;
    if (std::abs(u - 0.036F) < 0.018F && std::abs(v - 0.142F) < 0.004F) out.albedo *= 0.35F;
    if (u < 0.024F && std::abs(v - 0.055F) < 0.005F)
        out.albedo = out.albedo.cwiseProduct(Vec3f(0.6F, 0.35F, 0.35F));
    if (u < 0.010F && v > 0.082F && v < 0.088F) out.albedo *= 0.55F;
    if (unit(hash(s.finish.seed, 703U)) < 0.2F && u < 0.07F && v < 0.06F && v > 0.01F)
        out.albedo *= 0.4F;  // a beard
    return out;
}

}  // namespace

Shade personSurface(const SurfacePoint& s) {
    Shade out;
    switch (s.finish.material) {
        case Material::Cloth:
            return cloth(s);
        case Material::Skin:
            return face(s);
        case Material::Hair: {
            const float strand = valueNoise(s.uv.x() / 0.012F, s.uv.y() / 0.08F, s.finish.seed);
            out.albedo = s.finish.tint * (1.F + 0.4F * strand * visible(0.02F, s.footprint_m));
            out.reflectance = 0.2F;
            return out;
        }
        default: {  // shoes: a light sole (u is 0 at the instep) and a stripe
            const bool sole = std::abs(s.uv.x()) > 0.09F;
            const bool stripe = unit(hash(s.finish.seed, 704U)) < 0.4F &&
                                std::abs(s.uv.y() - 0.09F) < 0.012F && !sole;
            out.albedo = sole || stripe ? Vec3f(Vec3f::Constant(0.45F)) : s.finish.tint;
            out.part = sole || stripe ? 1U : 0U;
            return out;
        }
    }
}

Shade cycleSurface(const SurfacePoint& s) {
    Shade out;
    if (s.finish.material == Material::BikeWheel) {
        const bool rim = s.uv.norm() < 0.315F;
        out.albedo = Vec3f::Constant(rim ? 0.35F : 0.025F);
        out.reflectance = rim ? 0.4F : 0.05F;
        out.part = rim ? 1U : 0U;
        return out;
    }
    out.albedo = s.finish.tint;
    // The maker's decal.
    if (s.uv.y() > 0.12F && s.uv.y() < 0.32F) {
        const float ink = lettering(s.uv.y() - 0.22F, s.uv.x() - 0.035F, 0.025F, 0.16F,
                                    s.finish.seed, s.footprint_m);
        out.albedo +=
            ink * (Vec3f::Constant(s.finish.tint.mean() > 0.3F ? 0.05F : 0.6F) - out.albedo);
    }
    out.gloss = 0.05F;
    out.reflectance = 0.3F;
    return out;
}

}  // namespace djpete::simulator
