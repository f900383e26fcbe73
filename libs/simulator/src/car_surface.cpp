#include <algorithm>
#include <cmath>

#include "materials.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

enum Part : uint32_t {
    kPaint,
    kGlass,
    kTrim,
    kGrille,
    kHeadLight,
    kTailLight,
    kPlate,
    kArch,
    kGap
};

/// Position on a car in the terms of its outline.
struct OnCar {
    float x, y, z;    // length fraction -0.5 .. 0.5, metres to the left, height fraction 0 .. 1
    float half;       // half of the width here, m
    float glassHalf;  // half of the greenhouse's width at this height, m
    bool side;
};

OnCar locate(const SurfacePoint& s) {
    const CarOutline& o = s.car->outline;
    OnCar at{};
    at.x = s.p_obj.x() / o.length_m;
    at.y = s.p_obj.y();
    at.z = s.p_obj.z() / o.height_m + 0.5F;
    at.half = o.halfWidthAt(at.x);
    const float lean = o.belt < 0.6F ? 0.16F : 0.30F;
    at.glassHalf = 0.945F * at.half - lean * std::max(0.F, (at.z - o.belt) * o.height_m);
    at.side = std::abs(s.n_obj.y()) > 0.6F;
    return at;
}

bool onSideWindow(const CarOutline& o, const OnCar& at) {
    if (!at.side || at.z < o.belt + 0.012F || at.z > o.topAt(at.x) - 0.085F) return false;
    if (at.x < o.sideRear || at.x > o.cowl + 0.02F) return false;
    return std::abs(at.x - o.pillar) > 0.011F && std::abs(at.x - o.pillar2) > 0.009F;
}

bool onScreen(const CarOutline& o, const OnCar& at, const Vec3f& n) {
    const float rim = at.glassHalf - 0.07F;
    if (std::abs(at.y) > rim) return false;
    const float foot = o.topAt(o.cowl);
    if (n.x() > 0.2F && at.x > 0.F && at.z > foot + 0.012F && at.z < 0.962F) return true;
    const float rearFoot = std::max(o.belt + 0.03F, o.topAt(o.rearFoot) + 0.012F);
    return n.x() < -0.25F && at.x < o.rearHead + 0.02F && at.x > o.rearFoot - 0.02F &&
           at.z > rearFoot && at.z < 0.945F;
}

float arch(const CarOutline& o, const Vec3f& p) {
    const float z = p.z() + 0.5F * o.height_m - o.wheelRadius_m;
    return std::min(std::hypot(p.x() - o.wheelFront * o.length_m, z),
                    std::hypot(p.x() - o.wheelRear * o.length_m, z));
}

/// Letters of a number plate: bars in a grid of glyphs.
float plateInk(float y, float z, uint32_t seed) {
    const float column = y / 0.058F;
    const float inside = column - std::floor(column);
    if (inside < 0.15F || inside > 0.85F || std::abs(z) > 0.036F) return 0;
    const uint32_t glyph = hash(cellOf(column), seed);
    const uint32_t bit = static_cast<uint32_t>((z + 0.036F) / 0.0145F) * 3U +
                         static_cast<uint32_t>((inside - 0.15F) / 0.234F);
    return static_cast<float>((glyph >> (bit % 24U)) & 1U);
}

Shade glassOf(const SurfacePoint& s, const OnCar& at) {
    Shade out;
    const float inside = valueNoise(4.F * s.p_obj.x() + at.y, 5.F * s.p_obj.z(), s.finish.seed);
    const bool seat = s.p_obj.z() / s.car->outline.height_m < 0.27F && inside > 0.1F;
    out.albedo = Vec3f(0.022F, 0.025F, 0.027F) * (1.F + 0.5F * inside + (seat ? 1.2F : 0.F));
    out.gloss = 0.13F;
    out.reflectance = 0.05F;
    out.returns = 0.35F;
    out.part = kGlass;
    return out;
}

bool onLights(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const float lampTop = o.topAt(0.455F) - 0.015F;
    if (at.x > 0.40F && at.z < lampTop && at.z > lampTop - 0.095F &&
        std::abs(at.y) > 0.60F * at.half && s.n_obj.z() < 0.85F) {
        const float ring = std::sin(70.F * at.z) * std::sin(55.F * at.y);
        out.albedo = Vec3f::Constant(0.50F + 0.22F * ring);
        out.gloss = 0.12F;
        out.reflectance = 0.7F;
        out.part = kHeadLight;
        return true;
    }
    const float low = o.belt < 0.6F || o.pillar > 0.F ? 0.42F : 0.50F;
    if (at.x < -0.462F && at.z > low && at.z < low + 0.16F && std::abs(at.y) > 0.72F * at.half) {
        const bool white = std::abs(at.z - low - 0.03F) < 0.016F;
        out.albedo = white ? Vec3f(0.55F, 0.50F, 0.46F) : Vec3f(0.36F, 0.018F, 0.018F);
        out.gloss = 0.06F;
        out.reflectance = 0.8F;
        out.part = kTailLight;
        return true;
    }
    return false;
}

bool onEnds(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const bool front = at.x > 0.455F, rear = at.x < -0.462F;
    if (!front && !rear) return false;
    const float middle = (front ? 0.30F : 0.445F) * o.height_m;  // of the plate
    const float z = at.z * o.height_m - middle;
    if (std::abs(at.y) < 0.26F && std::abs(z) < 0.056F) {
        out.albedo = Vec3f::Constant(
            0.74F - 0.68F * plateInk(at.y, z, s.finish.seed) * visible(0.04F, s.footprint_m) -
            0.25F * (1.F - visible(0.04F, s.footprint_m)));
        out.reflectance = 0.95F;
        out.part = kPlate;
        return true;
    }
    const float top = o.topAt(0.47F) - 0.05F;
    if (front && at.z < top && at.z > top - 0.07F && std::abs(at.y) < 0.5F * at.half) {
        const float bars = std::sin(6.2832F * at.z * o.height_m / 0.035F);
        out.albedo = Vec3f::Constant(0.03F + 0.04F * std::max(0.F, bars));
        out.part = kGrille;
        return true;
    }
    if (front && at.z < 0.235F && at.z > 0.17F && std::abs(at.y) < 0.65F * at.half) {
        out.albedo = Vec3f::Constant(0.02F);
        out.part = kGrille;
        return true;
    }
    return false;
}

/// Seams between doors, bonnet and boot, handles, moulding, stripes.
void addSeams(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const float seam = std::max(0.006F, 0.5F * s.footprint_m);
    const auto near = [seam](float d) { return std::abs(d) < seam; };
    const float depth = std::min(1.F, 0.012F / (2.F * seam));
    const float x = s.p_obj.x(), y = std::abs(at.y);
    if (at.side && at.z > 0.2F) {
        const float door0 = 0.5F * (o.cowl + 0.165F) * o.length_m, door1 = o.pillar * o.length_m,
                    door2 = (std::max(o.sideRear, o.wheelRear) + 0.025F) * o.length_m;
        const bool van = o.belt < 0.6F;
        if (near(x - door0) || near(x - (van ? 0.07F * o.length_m : door1)) || near(x - door2)) {
            out.albedo *= 1.F - 0.85F * depth;
            out.part = kGap;
        }
        const float handleZ = o.belt - 0.055F;
        for (float edge : {door1, door2})
            if (std::abs(x - edge - 0.13F) < 0.085F && std::abs(at.z - handleZ) < 0.011F)
                out.albedo = Vec3f::Constant(0.05F);
        if (unit(hash(s.finish.seed, 61U)) < 0.4F && std::abs(at.z - 0.36F) < 0.017F)
            out.albedo = Vec3f::Constant(0.03F), out.part = kTrim;
    } else if (at.x > o.cowl && s.n_obj.z() > 0.5F && near(y - 0.80F * at.half)) {
        out.albedo *= 1.F - 0.7F * depth;
    } else if (at.x < -0.462F && at.z > 0.3F &&
               (near(y - 0.70F * at.half) || near((at.z - 0.33F) * o.height_m))) {
        out.albedo *= 1.F - 0.8F * depth;
    }
}

}  // namespace

Vec3f carPaint(uint32_t seed) {
    static const std::array<Vec3f, 14> kPaints{
        Vec3f(0.42F, 0.025F, 0.02F),   Vec3f(0.02F, 0.055F, 0.25F), Vec3f(0.70F, 0.70F, 0.68F),
        Vec3f(0.016F, 0.016F, 0.018F), Vec3f(0.33F, 0.34F, 0.35F),  Vec3f(0.02F, 0.12F, 0.05F),
        Vec3f(0.60F, 0.38F, 0.02F),    Vec3f(0.065F, 0.07F, 0.08F), Vec3f(0.04F, 0.17F, 0.33F),
        Vec3f(0.52F, 0.15F, 0.02F),    Vec3f(0.30F, 0.25F, 0.17F),  Vec3f(0.16F, 0.012F, 0.03F),
        Vec3f(0.20F, 0.28F, 0.34F),    Vec3f(0.50F, 0.50F, 0.47F)};
    return between(hash(seed, 31U), 0.85F, 1.1F) * kPaints.at(hash(seed, 30U) % kPaints.size());
}

Shade carSurface(const SurfacePoint& s) {
    const CarOutline& o = s.car->outline;
    const OnCar at = locate(s);
    Shade out;
    if (onSideWindow(o, at) || onScreen(o, at, s.n_obj)) return glassOf(s, at);
    const Vec3f paint = carPaint(s.finish.seed);
    const Vec2f where(s.p_obj.x() + 0.7F * s.p_obj.y(), s.p_obj.z());
    const float dirt =
        TextureBank::shared().stains().sampleRound(8.F * where, 8.F * s.footprint_m).x();
    out.albedo = paint * (0.8F + 0.2F * dirt);
    out.albedo += Vec3f(0.05F, 0.045F, 0.035F) * std::max(0.F, 0.45F - at.z) * dirt;  // road dust
    out.gloss = 0.045F;
    out.reflectance = 0.08F + 0.75F * std::sqrt(paint.mean());
    if (at.side && arch(o, s.p_obj) < o.wheelRadius_m + 0.055F) {
        out.albedo = Vec3f::Constant(0.012F);
        out.gloss = 0;
        out.part = kArch;
        return out;
    }
    if (onLights(s, at, out) || onEnds(s, at, out)) return out;
    const bool rubber =
        at.z < 0.165F || (at.side && at.z > o.belt - 0.002F && at.z < o.belt + 0.012F &&
                          at.x < o.cowl && at.x > o.sideRear);
    if (rubber) {
        out.albedo = Vec3f::Constant(0.03F);
        out.gloss = 0.01F;
        out.part = kTrim;
        return out;
    }
    addSeams(s, at, out);
    // Vans carry a firm's stripe and letters.
    if (o.belt < 0.6F && at.side && at.x < 0.03F && std::abs(at.z - 0.62F) < 0.09F &&
        unit(hash(s.finish.seed, 62U)) < 0.7F) {
        const Vec3f ink = carPaint(hash(s.finish.seed, 63U));
        const float glyph = plateInk(s.p_obj.x() / 4.F, (at.z - 0.62F) * 0.45F, s.finish.seed + 5U);
        if (glyph > 0.5F) out.albedo = ink, out.part = kPlate;
    }
    return out;
}

Shade wheelSurface(const SurfacePoint& s) {
    const CarOutline& o = s.car->outline;
    const float r = arch(o, s.p_obj) / o.wheelRadius_m;
    Shade out;
    out.albedo = Vec3f::Constant(0.025F);
    out.reflectance = 0.04F;
    if (std::abs(s.n_obj.y()) < 0.7F || r > 0.70F) return out;
    const float axle = (s.p_obj.x() > 0 ? o.wheelFront : o.wheelRear) * o.length_m;
    const float angle =
        std::atan2(s.p_obj.z() + 0.5F * o.height_m - o.wheelRadius_m, s.p_obj.x() - axle);
    const float spokes = 5.F + static_cast<float>(hash(s.finish.seed, 64U) % 5U);
    const bool metal = r > 0.60F || r < 0.2F || std::cos(spokes * angle + 0.7F) > 0.0F;
    out.albedo = Vec3f::Constant(metal ? 0.36F : 0.03F);
    out.gloss = metal ? 0.08F : 0.F;
    out.reflectance = 0.5F;
    out.part = metal ? 1U : 2U;
    return out;
}

}  // namespace djpete::simulator
