#include <algorithm>
#include <cmath>

#include "car_place.h"
#include "noise.h"

namespace djpete::simulator {

namespace {

using Marking = CarLook::Marking;

void paintOver(Shade& out, const Vec3f& ink, float share) {
    out.albedo += share * (ink - out.albedo);
    if (share > 0.5F) out.part = kMark;
}

/// A round emblem: ring, disc and a pattern of wedges; `x`, `z` from its middle.
void addLogo(float x, float z, float radius, const CarLook& look, Shade& out) {
    const float r = std::hypot(x, z) / radius;
    if (r > 1.F) return;
    const float wedges = 2.F + static_cast<float>(hash(look.seed, 510U) % 4U);
    const bool wedge = std::cos(wedges * std::atan2(z, x) + 6.28F * unit(look.seed)) > 0;
    const Vec3f second = Vec3f::Constant(look.ink.mean() > 0.3F ? 0.03F : 0.68F);
    paintOver(out, r > 0.84F || (r < 0.68F && wedge) ? look.ink : second, 1.F);
}

/// Sides of a lettered van: a company's name, a second line and its logo.
void addLettersOnFlank(const SurfacePoint& s, const OnCar& at, float along, Shade& out) {
    const CarOutline& o = s.car->outline;
    const CarLook& look = s.car->look;
    const float rear = -0.42F * o.length_m, front = (o.van ? 0.02F : 0.3F) * o.length_m;
    const float middle = 0.5F * (rear + front), length = front - rear;
    const float high = o.van ? 0.72F * o.height_m : 0.40F * o.height_m;
    const float tall = between(hash(look.seed, 511U), 0.24F, 0.38F) * (o.van ? 1.F : 0.45F);
    const float mirror = at.y > 0 ? -1.F : 1.F;  // legible from both sides
    const float x = mirror * (along - middle);
    addLogo(x + 0.5F * length - 0.30F, at.p.z() - high, 0.26F * (o.van ? 1.F : 0.5F), look, out);
    const float row =
        lettering(x - 0.35F, at.p.z() - high, tall, 0.66F * length, look.seed + 1U, s.footprint_m);
    paintOver(out, look.ink, row);
    const float below = lettering(x - 0.1F, at.p.z() - high + 0.85F * tall, 0.35F * tall,
                                  0.5F * length, look.seed + 2U, s.footprint_m);
    paintOver(out, look.ink, 0.9F * below);
}

/// Coloured areas over the flank: a wave or a wedge.
void addFlank(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarLook& look = s.car->look;
    const float style = unit(hash(look.seed, 512U));
    float edge = 0;
    if (style < 0.35F)
        edge = 0.45F + 0.5F * at.x;
    else if (style < 0.7F)
        edge = 0.42F + 0.07F * std::sin(9.F * at.x + 6.28F * style);
    else
        edge = at.x > 0.F ? 0.2F : 0.52F - 0.2F * at.x;
    const float d = at.z - edge;
    if (d < 0) paintOver(out, look.ink, 1.F);
    if (d > 0.02F && d < 0.045F) paintOver(out, 0.5F * (look.ink + look.paint), 1.F);
}

/// Small things that people stick on: each a few words or a picture of its own.
void addStickers(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const uint32_t seed = s.car->look.seed;
    if (at.x > -0.455F || at.side) return;
    for (uint32_t i = 0; i < 2; ++i) {
        const uint32_t h = hash(seed, 520U, i);
        if (unit(h) > 0.4F) continue;
        const float y = at.y - between(hash(h, 1U), -0.35F, 0.35F) * o.width_m;
        const float z = at.p.z() - between(hash(h, 2U), 0.36F, 0.56F) * o.height_m;
        const float w = between(hash(h, 3U), 0.05F, 0.14F),
                    tall = between(hash(h, 4U), 0.03F, 0.06F);
        if (std::abs(y) > w || std::abs(z) > tall) continue;
        const bool ink = unit(hash(cellOf(y / 0.022F), cellOf(z / 0.022F), h)) < 0.45F &&
                         std::abs(y) < 0.85F * w;
        const Vec3f ground = carPaint(hash(h, 5U));
        paintOver(out, ink ? Vec3f(Vec3f::Constant(ground.mean() > 0.3F ? 0.03F : 0.65F)) : ground,
                  1.F);
    }
    // The maker's name and the model.
    const float z = at.p.z() - 0.575F * o.height_m;
    const float shine = s.car->look.paint.mean() > 0.5F ? 0.10F : 0.50F;
    const float name =
        std::max(lettering(-at.y - 0.30F * o.width_m, z, 0.035F, 0.22F, seed + 6U, s.footprint_m),
                 lettering(-at.y + 0.30F * o.width_m, z, 0.035F, 0.16F, seed + 7U, s.footprint_m));
    paintOver(out, Vec3f::Constant(shine), name);
    if (std::hypot(at.y, z + 0.02F) < 0.05F) paintOver(out, Vec3f::Constant(0.45F), 1.F);
}

}  // namespace

float lettering(float x, float z, float height_m, float length_m, uint32_t seed,
                float footprint_m) {
    const float pitch = kLetterPitch * height_m;
    length_m = pitch * std::floor(length_m / pitch);  // whole letters
    if (std::abs(x) > 0.5F * length_m || std::abs(z) > 0.5F * height_m) return 0;
    const float seen = visible(0.4F * height_m, footprint_m);
    const bool ink = letterAt((x + 0.5F * length_m) / height_m, z / height_m, seed);
    return 0.4F * (1.F - seen) + (ink ? seen : 0.F);
}

void addMarkings(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const CarLook& look = s.car->look;
    if (o.cab) return;  // the box carries the marks
    const float waist = (o.belt - 0.09F) * o.height_m;
    switch (look.marking) {
        case Marking::RacingStripes:
            if (!at.side && std::abs(std::abs(at.y) - 0.17F) < 0.10F) paintOver(out, look.ink, 1.F);
            break;
        case Marking::SideStripe:
            if (at.side && (std::abs(at.p.z() - waist + 0.05F) < 0.045F ||
                            std::abs(at.p.z() - waist + 0.13F) < 0.012F))
                paintOver(out, look.ink, 1.F);
            break;
        case Marking::DoorLogo:
            if (at.side)
                addLogo(at.p.x() - (o.pillar + 0.13F) * o.length_m, at.p.z() - waist + 0.16F, 0.19F,
                        look, out);
            break;
        case Marking::Flank:
            if (at.side) addFlank(s, at, out);
            if (at.side) addLettersOnFlank(s, at, at.p.x(), out);
            break;
        case Marking::Letters:
            if (at.side) addLettersOnFlank(s, at, at.p.x(), out);
            if (at.x < -0.47F && !at.side)
                paintOver(out, look.ink,
                          lettering(-at.y, at.p.z() - 0.52F * o.height_m, 0.11F, 1.2F,
                                    look.seed + 1U, s.footprint_m));
            break;
        default:
            break;
    }
    addStickers(s, at, out);
}

void addSeams(const SurfacePoint& s, const OnCar& at, Shade& out) {
    const CarOutline& o = s.car->outline;
    const CarLook& look = s.car->look;
    const float seam = std::max(0.006F, 0.5F * s.footprint_m);
    const auto near = [seam](float d) { return std::abs(d) < seam; };
    const float depth = std::min(1.F, 0.012F / (2.F * seam));
    const auto gap = [&](float strength) {
        out.albedo *= 1.F - strength * depth;
        out.part = kGap;
    };
    const float x = at.p.x(), y = std::abs(at.y);
    if (at.side && at.z > 0.2F) {
        const float door0 = 0.5F * (o.cowl + 0.165F) * o.length_m,
                    door1 = (o.van ? o.sideRear - 0.02F : o.pillar) * o.length_m,
                    door2 = o.van ? door1 - 0.24F * o.length_m
                                  : (std::max(o.sideRear, o.wheelRear) + 0.025F) * o.length_m;
        if (near(x - door0) || near(x - door1) || near(x - door2)) gap(0.85F);
        const float handleZ = (o.belt - 0.055F) * o.height_m;
        const bool paintedHandle = unit(hash(look.seed, 61U)) < 0.6F;
        for (float edge : {door1, door2}) {
            const float dx = std::abs(x - edge - 0.13F), dz = at.p.z() - handleZ;
            if (dx < 0.10F && std::abs(dz) < 0.016F) {
                if (!paintedHandle) out.albedo = Vec3f::Constant(look.chrome ? 0.45F : 0.03F);
                if (dz < -0.004F) out.albedo *= 0.45F;  // the shadow of the grip
                out.part = kTrim;
            }
        }
        if (look.moulding && std::abs(at.z - 0.34F) < 0.022F && at.x < 0.25F && at.x > -0.24F)
            out.albedo = Vec3f::Constant(0.03F), out.part = kTrim;
        const float flapX = std::abs(x - (o.wheelRear - 0.055F) * o.length_m),
                    flapZ = std::abs(at.p.z() - (o.belt - 0.06F) * o.height_m);
        if (at.y < 0 && !o.van && near(std::max(flapX, flapZ) - 0.085F)) gap(0.6F);
        if (o.van && x < door1 && near(at.p.z() - 0.52F * o.height_m)) gap(0.5F);  // door rail
    } else if (at.x > o.cowl && s.n_obj.z() > 0.5F && near(y - 0.80F * at.half)) {
        gap(0.7F);
    } else if (at.x > 0.45F && near(at.p.z() - (o.topAt(0.46F) - 0.05F) * o.height_m)) {
        gap(0.6F);  // between bonnet and bumper
    } else if (at.x < -0.462F && at.z > 0.3F &&
               (near(y - 0.72F * at.half) || near((at.z - 0.33F) * o.height_m) ||
                (o.van && near(at.y)))) {
        gap(0.8F);
    }
}

}  // namespace djpete::simulator
