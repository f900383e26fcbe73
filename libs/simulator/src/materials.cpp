#include "materials.h"

#include <algorithm>
#include <cmath>

#include "ground_wear.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

Vec3f grey(float v) { return Vec3f::Constant(v); }
float fract(float x) { return x - std::floor(x); }
Vec3f mix(const Vec3f& a, const Vec3f& b, float f) { return a + f * (b - a); }
float ramp(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.F, 1.F);
    return t * t * (3.F - 2.F * t);
}

/// Share of a sample of `footprint` that lies within `half` of 0, for a line at distance `d`.
float line(float d, float half, float footprint) {
    const float edge = std::max(footprint, 1e-4F);
    return std::clamp((half - std::abs(d)) / edge + 0.5F, 0.F, 1.F) *
           std::min(1.F, 2.F * half / edge);
}

/// Of a disc about as large as the pixel's footprint.
float roundWidth(const SurfacePoint& s) {
    return std::sqrt(s.footprint_m * std::max(s.footprint_m, s.major_m.norm()));
}

/// Stains over many metres, other ones on each thing.
float stains(const SurfacePoint& s) {
    const Material m = s.finish.material;
    if (m == Material::Pavement || m == Material::Kerb || m == Material::Grass)
        return groundStainsAt(s.uv, roundWidth(s), s.finish.seed);
    const Vec2f off(31.F * unit(hash(s.finish.seed, 1U)), 17.F * unit(hash(s.finish.seed, 2U)));
    return TextureBank::shared().stains().sampleRound(s.uv + off, roundWidth(s)).x();
}

/// Tint times texture times stains; `stain` 0..1 tells how strongly stains show.
Vec3f textured(const SurfacePoint& s, float stain) {
    const TextureBank& bank = TextureBank::shared();
    Vec3f c = s.finish.tint;
    if (const Texture* t = bank.of(s.finish.material)) {
        const float shift = 7.3F * unit(s.finish.seed);
        c = c.cwiseProduct(t->sample(s.uv + Vec2f(shift, 0), s.major_m, s.footprint_m));
    }
    if (stain > 0) c *= 1.F + stain * (stains(s) - 1.F);
    return c;
}

/// Lane marks, patched squares and manholes on top of the asphalt; uv = (s, lateral).
Shade asphalt(const SurfacePoint& s) {
    const float u = s.uv.x(), v = s.uv.y();
    const float fv = std::max(s.footprint_m, std::abs(s.major_m.y()));
    Shade out;
    const float wornTo = roadWearAt(s.uv, roundWidth(s), s.finish.seed);
    out.albedo = wornTo * textured(s, 0.F);
    const float cellU = u / 9.F, cellV = v / 2.6F;
    const uint32_t patch = hash(cellOf(cellU), cellOf(cellV), s.finish.seed);
    if (unit(patch) < 0.09F) {
        const float du = std::abs(fract(cellU) - 0.5F) - between(hash(patch, 1U), 0.1F, 0.42F);
        const float dv = std::abs(fract(cellV) - 0.5F) - between(hash(patch, 2U), 0.2F, 0.47F);
        const float outside = std::max(9.F * du, 2.6F * dv);
        if (outside < 0) out.albedo *= between(hash(patch, 3U), 0.72F, 0.92F), out.part = 3;
        if (std::abs(outside) < 0.025F) out.albedo *= 0.55F;
    }
    const float wear = 0.35F + 0.65F * ramp(0.045F, 0.11F, out.albedo.x());
    // Few of these streets have lines.
    const float centre = unit(hash(s.finish.seed, 77U)) < 0.35F ? 1.F : 0.F;
    float paint = centre * line(v, 0.06F, fv) * (fract(u / 9.F) < 0.40F ? 1.F : 0.F);
    const float edge = unit(hash(s.finish.seed, 78U)) < 0.5F ? 1.F : 0.F;
    paint = std::max(
        paint, edge * line(std::abs(v) - 3.15F, 0.05F, fv) * (fract(u / 5.5F) < 0.93F ? 1.F : 0.F));
    const float cell = std::floor(u / 23.F);
    const uint32_t c = hash(cellOf(cell), s.finish.seed);
    const float mu = u - 23.F * (cell + 0.3F + 0.4F * unit(hash(c, 9U)));
    const float mv = v - between(hash(c, 10U), -2.2F, 2.2F);
    const float hole = std::sqrt(mu * mu + mv * mv);
    if (hole < 0.33F) {
        const bool rib = std::sin(mu * 75.F) * std::sin(mv * 75.F) > 0.F;
        out.albedo = grey(hole > 0.30F ? 0.05F : (rib ? 0.12F : 0.07F));
        out.part = 4;
    }
    out.albedo = mix(out.albedo, grey(0.58F), 0.85F * paint * wear);
    if (paint > 0.4F) out.part = 5;
    out.reflectance = 0.18F + 0.6F * paint + 0.5F * (out.albedo.x() - 0.15F);
    return out;
}

Shade glass(const SurfacePoint& s) {
    const uint32_t id = s.finish.seed;
    const float u = s.uv.x(), v = s.uv.y(), fp = s.footprint_m;
    Shade out;
    const float kind = unit(hash(id, 7U));
    if (kind < 0.45F) {  // a curtain behind it
        const float fold = std::sin(u * between(id, 28.F, 55.F) + 3.F * valueNoise(u * 2.F, v, id));
        out.albedo = mix(Vec3f(0.30F, 0.29F, 0.26F), Vec3f(0.17F, 0.16F, 0.14F),
                         0.5F + 0.5F * fold * visible(0.16F, fp));
        if (kind < 0.15F && v < 0.55F) out.albedo *= 0.25F;
    } else if (kind < 0.60F) {  // a roller blind, partly down
        const float edge = between(hash(id, 8U), 0.3F, 1.2F);
        const float slat = 0.82F + 0.18F * std::sin(v * 130.F) * visible(0.05F, fp);
        out.albedo = v > edge ? Vec3f(0.40F * slat * Vec3f::Ones()) : grey(0.025F);
        out.part = v > edge ? 1U : 0U;
    } else {
        out.albedo =
            Vec3f(0.035F, 0.037F, 0.04F) * (1.F + 0.9F * valueNoise(u * 2.2F, v * 1.7F, id));
    }
    out.gloss = 0.10F;
    out.reflectance = 0.10F;
    out.returns = 0.4F;
    return out;
}

/// Traffic signs, told by their colour: one way, no entry, a limit, right of way.
Shade sign(const SurfacePoint& s) {
    Shade out;
    const float u = s.uv.x() - 0.3F, v = s.uv.y() - 0.3F, r = std::sqrt(u * u + v * v);
    const Vec3f& t = s.finish.tint;
    const Vec3f white = grey(0.70F), black = grey(0.03F), red(0.55F, 0.04F, 0.04F);
    const bool rim = std::max(std::abs(u), std::abs(v)) > 0.27F;
    if (v > 0.3F) {  // the plate above or below: a line of text
        const bool ink = std::abs(v - 0.43F) < 0.04F && std::abs(u) < 0.2F &&
                         unit(hash(cellOf(u / 0.025F), s.finish.seed)) < 0.6F;
        out.albedo = ink ? black : white;
        out.part = ink ? 2 : 1;
    } else if (t.z() > 2.F * t.x()) {
        const bool arrow =
            std::abs(v) < 0.035F ? std::abs(u) < 0.2F : u > 0.05F && u + std::abs(v) < 0.2F;
        out.albedo = rim || arrow ? white : t;
        out.part = rim || arrow ? 1 : 3;
    } else if (t.x() > 4.F * t.y()) {
        const bool bar = std::abs(v) < 0.045F && std::abs(u) < 0.2F;
        out.albedo = rim || bar ? white : t;
        out.part = rim || bar ? 1 : 3;
    } else if (t.minCoeff() > 0.4F) {
        const bool digits = std::abs(v) < 0.1F && (std::abs(std::abs(u) - 0.06F) < 0.02F);
        out.albedo = r > 0.2F && r < 0.27F ? red : (digits ? black : white);
        out.part = digits ? 2 : (r > 0.2F && r < 0.27F ? 3 : 1);
    } else {
        const float d = std::abs(u) + std::abs(v);
        out.albedo = d < 0.22F ? t : (d < 0.3F ? white : grey(0.35F));
        out.part = d < 0.22F ? 3 : (d < 0.3F ? 1 : 2);
    }
    out.reflectance = 0.97F;
    return out;
}

}  // namespace

Vec3f sky(const Vec3f& d) {
    const float up = std::clamp(d.z(), 0.F, 1.F);
    if (d.z() < 0.043F) {  // the skyline is nowhere higher
        const float azimuth = std::atan2(d.y(), d.x()) * 57.29578F;
        const float skyline =
            0.020F + 0.022F * fractalNoise(azimuth, 0.F, 24.F, 0.8F, 0.65F, 0.05F, 99U);
        if (d.z() < skyline) {
            const float tone = fractalNoise(azimuth, 90.F * d.z(), 6.F, 0.5F, 0.7F, 0.1F, 98U);
            return Vec3f(0.19F, 0.23F, 0.22F) * (1.F + 0.35F * tone) + grey(0.05F);
        }
    }
    const float cloud = fractalNoise(3.F * d.x() / (up + 0.22F), 3.F * d.y() / (up + 0.22F), 3.F,
                                     0.08F, 0.58F, 0.02F, 4711U);
    // As a grey camera exposed for the street sees it: far from white.
    const Vec3f blue = mix(Vec3f(0.46F, 0.50F, 0.54F), Vec3f(0.14F, 0.23F, 0.42F), std::sqrt(up));
    return mix(blue, Vec3f(0.60F, 0.61F, 0.62F), 0.7F * ramp(0.1F, 0.6F, cloud));
}

Vec3f mirrored(const Vec3f& d) {
    if (d.z() < -0.02F) return Vec3f(0.13F, 0.13F, 0.125F);
    const float along = std::abs(d.x());
    const float houses = 0.62F - 0.5F * along * along;  // open along the street
    const Vec3f front(0.20F, 0.18F, 0.155F);
    const Vec3f above = mix(Vec3f(0.75F, 0.83F, 0.92F), Vec3f(0.30F, 0.48F, 0.80F), d.z());
    return mix(front, above, ramp(houses - 0.06F, houses + 0.06F, d.z()));
}

Shade shade(const SurfacePoint& s) {
    Shade out;
    switch (s.finish.material) {
        case Material::Asphalt:
            return asphalt(s);
        case Material::Glass:
            return glass(s);
        case Material::Sign:
            return sign(s);
        case Material::CarBody:
            return carSurface(s);
        case Material::Tyre:
            return wheelSurface(s);
        case Material::Cargo:
            return cargoSurface(s);
        case Material::Cloth:
        case Material::Skin:
        case Material::Hair:
        case Material::Shoe:
            return personSurface(s);
        case Material::BikeFrame:
        case Material::BikeWheel:
            return cycleSurface(s);
        case Material::Leaf:
            out.albedo = s.finish.tint;
            out.reflectance = 0.35F;
            out.depth_m = 0.3F;
            return out;
        case Material::Brick:
        case Material::Plaster:
        case Material::Stone: {
            out.albedo = textured(s, 0.45F);
            out.albedo *= 0.86F + 0.14F * ramp(0.F, 1.2F, s.uv.y());  // splashes at the foot
            break;
        }
        case Material::Frame:
        case Material::Metal:
            out.albedo = textured(s, 0.35F);
            break;
        default:
            out.albedo = textured(s, 0.6F);
    }
    out.reflectance = std::clamp(0.08F + 0.8F * out.albedo.mean(), 0.F, 0.95F);
    return out;
}

}  // namespace djpete::simulator
