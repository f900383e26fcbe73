#include <algorithm>
#include <cmath>

#include "car_place.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

bool onSideWindow(const CarOutline& o, const OnCar& at) {
    if (!at.side || at.z < o.belt + 0.012F) return false;
    if (at.z * o.height_m > o.topAt(at.x) * o.height_m - (o.van ? 0.22F : 0.125F)) return false;
    if (at.x < o.sideRear || at.x > o.cowl + 0.02F) return false;
    // The rear edge of the last window leans with the car's tail.
    if (!o.van && at.x < o.sideRear + 0.35F * (at.z - o.belt) * o.height_m / o.length_m)
        return false;
    return std::abs(at.x - o.pillar) > 0.011F && std::abs(at.x - o.pillar2) > 0.009F;
}

bool onScreen(const CarOutline& o, const OnCar& at, const Vec3f& n) {
    const float rim = at.glassHalf - 0.07F;
    if (std::abs(at.y) > rim) return false;
    const float foot = o.topAt(o.cowl);
    if (n.x() > 0.2F && at.x > 0.F && at.z > foot + 0.012F && at.z < 0.962F) return true;
    if (o.van &&
        (unit(hash(static_cast<uint32_t>(o.length_m * 4096.F))) < 0.5F || std::abs(at.y) < 0.09F))
        return false;  // many vans have blind doors
    const float rearFoot = std::max(o.belt + 0.03F, o.topAt(o.rearFoot) + 0.012F);
    return n.x() < -0.25F && at.x < o.rearHead + 0.02F && at.x > o.rearFoot - 0.02F &&
           at.z > rearFoot && at.z < 0.945F;
}

/// Head rests, seats and what lies about, dimly, behind the glass.
Shade glassOf(const SurfacePoint& s, const OnCar& at) {
    const CarOutline& o = s.car->outline;
    Shade out;
    const float inside = valueNoise(4.F * at.p.x() + at.y, 5.F * at.p.z(), s.finish.seed);
    float tone = 1.F + 0.5F * inside;
    if (at.side) {
        for (float seat : {o.pillar - 0.01F, o.pillar2 - 0.01F}) {
            const float dx = (at.x - seat) * o.length_m,
                        dz = at.p.z() - (o.belt + 0.02F) * o.height_m;
            if (std::abs(dx) < 0.09F && dz < 0.24F && std::hypot(dx, dz - 0.19F) < 0.13F)
                tone += 1.6F;
        }
    } else if (at.x > 0) {
        const float dy = std::abs(std::abs(at.y) - 0.36F), dz = at.p.z() - 0.79F * o.height_m;
        if (std::hypot(dy, dz) < 0.11F || (dz < 0 && dy < 0.2F)) tone += o.van ? 0.4F : 0.8F;
        if (std::abs(at.y) < 0.1F && at.z > 0.925F) tone += 2.F;  // the inner mirror
        // Papers behind the windscreen.
        const uint32_t h = hash(s.finish.seed, 65U);
        if (unit(h) < 0.5F && std::abs(at.y - between(hash(h, 1U), -0.5F, 0.5F)) < 0.07F &&
            std::abs(at.z - o.topAt(o.cowl) - 0.045F) < 0.02F)
            tone += 12.F;
    } else if (at.z < o.belt + 0.06F) {
        tone += 1.2F;  // the parcel shelf
    }
    if (s.car->look.darkGlass && at.x < o.pillar) tone *= 0.4F;
    out.albedo = Vec3f(0.022F, 0.025F, 0.027F) * std::max(0.2F, tone);
    out.gloss = 0.13F;
    out.reflectance = 0.05F;
    out.returns = 0.35F;
    out.part = kGlass;
    return out;
}

bool onLights(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const uint32_t shape = s.car->look.lamp;
    const float lampTop = (o.topAt(0.455F) - 0.015F) * o.height_m;
    const float tall = shape == 0 ? 0.15F : shape == 1 ? 0.11F : 0.19F;
    const float inner = (shape == 2 ? 0.68F : 0.56F) * at.half;
    const float y = std::abs(at.y), below = lampTop - at.p.z();
    // The lower edge rises outwards.
    if (at.x > 0.405F && below > 0 && below < tall * (0.7F + 0.5F * (y - inner) / at.half) &&
        y > inner && s.n_obj.z() < 0.85F) {
        const float cup = std::hypot(y - 0.5F * (inner + at.half) + 0.01F, below - 0.5F * tall);
        const bool bulb = cup < 0.33F * tall, rim = cup < 0.42F * tall;
        out.albedo = bulb ? Vec3f(0.72F, 0.72F, 0.68F)
                          : Vec3f(Vec3f::Constant(rim ? 0.12F : (shape == 1 ? 0.22F : 0.45F)));
        if (y > 0.93F * at.half && at.x < 0.45F) out.albedo = Vec3f(0.55F, 0.22F, 0.03F);
        out.gloss = 0.12F;
        out.reflectance = 0.7F;
        out.part = kHeadLight;
        return true;
    }
    if (o.cab) return false;
    const bool upright = o.van || o.height_m > 1.6F || shape == 2;
    const float foot = (o.belt < 0.6F || o.pillar > 0.F ? 0.40F : 0.47F) * o.height_m;
    const float z = at.p.z() - foot, high = upright ? 0.34F : 0.17F;
    if (at.x < -0.462F && z > 0 && z < high && y > (upright ? 0.82F : 0.64F) * at.half) {
        const float part = z / high;
        const bool white = part > 0.22F && part < 0.38F, amber = part >= 0.38F && part < 0.55F;
        out.albedo = white   ? Vec3f(0.55F, 0.50F, 0.46F)
                     : amber ? Vec3f(0.45F, 0.14F, 0.02F)
                             : Vec3f(0.36F, 0.018F, 0.018F);
        out.gloss = 0.06F;
        out.reflectance = 0.8F;
        out.part = kTailLight;
        return true;
    }
    return false;
}

bool onPlate(const SurfacePoint& s, const OnCar& at, bool front, Shade& out) {
    const float middle = front ? std::max(0.36F, s.car->outline.clearance_m + 0.2F)
                               : (s.car->outline.van ? 0.62F : 0.66F);  // above the ground
    const float z = at.p.z() - middle, y = front ? at.y : -at.y;
    if (std::abs(y) > 0.275F || std::abs(z) > 0.068F) return false;
    out.part = kPlate;
    out.reflectance = 0.95F;
    if (std::abs(y) > 0.26F || std::abs(z) > 0.056F) {
        out.albedo = Vec3f::Constant(0.03F);
    } else if (y < -0.215F) {
        out.albedo = Vec3f(0.03F, 0.07F, 0.35F);
    } else {
        const float ink =
            lettering(y - 0.025F, z, 0.078F, 0.42F, s.car->look.seed + 5U, s.footprint_m);
        out.albedo = Vec3f::Constant(0.72F - 0.66F * ink);
    }
    return true;
}

bool onEnds(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const CarLook& look = s.car->look;
    const bool front = at.x > 0.455F, rear = at.x < -0.462F && !o.cab;
    if (!front && !rear) return false;
    if (onPlate(s, at, front, out)) return true;
    if (!front) return false;
    const float top = (o.topAt(0.47F) - 0.05F) * o.height_m, below = top - at.p.z();
    if (below > 0.01F && std::hypot(at.y, below - 0.055F) < 0.045F) {
        out.albedo = Vec3f::Constant(0.5F);
        out.part = kBadge;
        return true;
    }
    const float wide = 0.46F + 0.12F * unit(hash(look.seed, 66U));
    if (below > 0 && below < 0.11F && std::abs(at.y) < wide * at.half) {
        const bool bars = hash(look.seed, 67U) % 2U == 0U;
        const float wave =
            bars ? std::sin(6.2832F * at.p.z() / 0.035F)
                 : std::sin(6.2832F * at.y / 0.05F) * std::sin(6.2832F * at.p.z() / 0.05F);
        const bool edge = below < 0.012F || below > 0.098F;
        out.albedo = Vec3f::Constant(
            look.chrome && (edge || wave > 0.7F) ? 0.45F : 0.03F + 0.05F * std::max(0.F, wave));
        out.part = kGrille;
        return true;
    }
    // The mouth in the bumper, and fog lamps in its corners.
    const float z = at.p.z() - o.clearance_m;
    if (z < 0.19F && z > 0.06F && std::abs(at.y) < 0.62F * at.half) {
        out.albedo = Vec3f::Constant(0.02F);
        out.part = kGrille;
        return true;
    }
    if (std::hypot(std::abs(at.y) - 0.76F * at.half, z - 0.13F) < 0.05F) {
        out.albedo = Vec3f::Constant(0.5F);
        out.part = kHeadLight;
        return true;
    }
    return false;
}

/// Paint with its panels, road dust from below, streaks and stains.
void addPaint(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const CarLook& look = s.car->look;
    Vec3f paint = at.z > o.belt && s.n_obj.z() > 0.6F && at.x < o.cowl ? look.roof : look.paint;
    const float door0 = 0.5F * (o.cowl + 0.165F);
    if ((look.oddPanel == 0 && at.x > o.cowl && s.n_obj.z() > 0.5F) ||
        (look.oddPanel == 1 && at.side && at.y > 0 && at.x > o.pillar && at.x < door0))
        paint = carPaint(hash(look.seed, 68U));
    const Vec2f where(at.p.x() + 0.7F * at.y + 3.F * unit(look.seed), at.p.z());
    const float stains =
        TextureBank::shared().stains().sampleRound(8.F * where, 8.F * s.footprint_m).x();
    out.albedo = paint * (1.F + (0.15F + 0.25F * look.dirt) * (stains - 1.F));
    const float splash = std::max(0.F, 0.65F - at.p.z()) * (0.6F + 1.6F * look.dirt);
    const float dust =
        std::clamp((splash + 0.03F + 0.18F * look.dirt) * stains * stains, 0.F, 0.85F);
    out.albedo += dust * (Vec3f(0.16F, 0.14F, 0.115F) - out.albedo);
    out.gloss = (look.metallic ? 0.06F : 0.045F) * (1.F - 0.7F * look.dirt);
    out.reflectance = 0.08F + 0.75F * std::sqrt(paint.mean());
}

}  // namespace

OnCar locateOnCar(const SurfacePoint& s) {
    const CarOutline& o = s.car->outline;
    OnCar at{};
    at.p = s.p_obj - o.origin_obj;
    at.x = at.p.x() / o.length_m;
    at.y = at.p.y();
    at.z = at.p.z() / o.height_m;
    at.half = o.halfWidthAt(at.x);
    at.glassHalf = 0.945F * at.half - o.lean * std::max(0.F, (at.z - o.belt) * o.height_m);
    at.side = std::abs(s.n_obj.y()) > 0.6F;
    return at;
}

Shade carSurface(const SurfacePoint& s) {
    const CarOutline& o = s.car->outline;
    const OnCar at = locateOnCar(s);
    if (std::abs(at.y) < at.half - 0.001F || at.z < o.belt) {
        if (onSideWindow(o, at) || onScreen(o, at, s.n_obj)) return glassOf(s, at);
    }
    Shade out;
    addPaint(s, at, out);
    if (onLights(s, at, out) || onEnds(s, at, out)) return out;
    const auto archOf = [&](float wheel) {
        return std::hypot(at.p.x() - wheel * o.length_m, at.p.z() - o.wheelRadius_m);
    };
    const float arch = std::min(archOf(o.wheelFront), archOf(o.wheelRear)) - o.archRadius_m();
    const bool well = std::abs(at.y) < 0.93F * at.half && at.z < 0.4F;  // the inside of an arch
    const bool plastic = s.car->look.plasticArches && at.side && arch < 0.055F;
    const bool sill = at.p.z() < o.clearance_m + (s.car->look.plasticArches ? 0.12F : 0.05F);
    const bool seal = at.side && at.z > o.belt - 0.002F && at.z < o.belt + 0.012F &&
                      at.x < o.cowl && at.x > o.sideRear;
    if (plastic || sill || seal || (well && arch < 0.03F)) {
        out.albedo = Vec3f::Constant(seal && s.car->look.chrome ? 0.42F : 0.03F);
        out.gloss = 0.01F;
        out.part = kTrim;
        return out;
    }
    if (at.side && arch < 0.02F) out.albedo *= 0.75F;  // the folded edge of the arch
    addMarkings(s, at, out);
    addSeams(s, at, out);
    return out;
}

Shade wheelSurface(const SurfacePoint& s) {
    const CarLook& look = s.car->look;
    const float r = s.uv.norm() / s.car->outline.wheelRadius_m;
    Shade out;
    const float dust = 0.02F * look.dirt;
    out.albedo = Vec3f(0.025F + dust, 0.025F + 0.9F * dust, 0.025F + 0.7F * dust);
    out.reflectance = 0.04F;
    if (r > 0.69F || std::abs(s.n_obj.y()) < 0.3F) return out;
    const float angle = std::atan2(s.uv.y(), s.uv.x());
    static constexpr float kSpokes[6] = {5.F, 7.F, 10.F, 6.F, 9.F, 5.F};
    const float wave = std::cos(kSpokes[look.hub] * angle);
    bool metal = r > 0.60F || r < 0.20F;
    float tone = 0.38F;
    switch (look.hub) {
        case 3:  // a steel wheel with holes
            metal = !(r > 0.40F && r < 0.54F && wave > 0.3F);
            tone = r < 0.16F ? 0.30F : 0.035F;
            break;
        case 4:  // a hub cap
            metal = metal || !(r > 0.34F && r < 0.56F && wave > 0.45F);
            tone = 0.34F;
            break;
        case 5:  // double spokes
            metal = metal || (wave > 0.35F && wave < 0.93F);
            break;
        default:
            metal = metal || wave > 0.25F - 0.5F * (0.6F - r);
    }
    if (look.hub == 0 && unit(hash(look.seed, 64U)) < 0.4F) tone = 0.05F;  // black alloys
    const float bolt =
        std::hypot(r * std::cos(angle) - 0.12F * std::cos(std::round(angle / 1.2566F) * 1.2566F),
                   r * std::sin(angle) - 0.12F * std::sin(std::round(angle / 1.2566F) * 1.2566F));
    out.albedo = Vec3f::Constant(metal ? tone : 0.012F);
    if (bolt < 0.025F) out.albedo *= 0.3F;
    out.gloss = metal ? 0.08F : 0.F;
    out.reflectance = 0.5F;
    out.part = metal ? 1U : 2U;
    return out;
}

}  // namespace djpete::simulator
