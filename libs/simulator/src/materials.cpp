#include "materials.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

Vec3f grey(float v) { return Vec3f::Constant(v); }

float fract(float x) { return x - std::floor(x); }

/// Share of a sample of `footprint` that lies within `half` of 0, for a line at distance `d`.
float line(float d, float half, float footprint) {
    const float edge = std::max(footprint, 1e-4F);
    return std::clamp((half - std::abs(d)) / edge + 0.5F, 0.F, 1.F) *
           std::min(1.F, 2.F * half / edge + 0.2F);
}

Vec3f mix(const Vec3f& a, const Vec3f& b, float f) { return a + f * (b - a); }

Shade asphalt(const SurfacePoint& s) {
    const float u = s.uv.x(), v = s.uv.y(), fp = s.footprint_m;
    float tone = 0.27F + 0.075F * fractalNoise(u, v, 3.2F, 0.02F, 0.85F, fp, s.seed + 11);
    const float patch = valueNoise(u / 5.F, v / 1.7F, s.seed + 5);
    if (patch > 0.45F) tone -= 0.06F;
    const float crack = fractalNoise(u, v, 2.0F, 0.1F, 0.6F, fp, s.seed + 77);
    tone -= 0.10F * line(crack, 0.015F, 0.02F + fp);
    const float wear = 0.75F + 0.25F * fractalNoise(u, v, 0.8F, 0.05F, 0.8F, fp, s.seed + 31);
    float paint = line(v, 0.07F, fp) * (fract(u / 9.F) < 0.40F ? 1.F : 0.F);
    paint = std::max(paint, line(std::abs(v) - 3.15F, 0.05F, fp));
    const float cell = std::floor(u / 23.F);
    const auto c = static_cast<uint32_t>(static_cast<int32_t>(cell));
    const float mu = u - 23.F * (cell + 0.3F + 0.4F * unit(hash(c, 9U)));
    const float mv = v - between(hash(c, 10U), -2.2F, 2.2F);
    const float hole = std::sqrt(mu * mu + mv * mv);
    if (hole < 0.33F) tone = 0.16F + 0.06F * line(fract(mu * 9.F) - 0.5F, 0.2F, fp * 9.F);
    Shade out;
    out.albedo = mix(grey(tone), grey(0.78F), 0.8F * paint * wear);
    out.reflectance = 0.12F + 0.5F * paint;
    return out;
}

Shade pavement(const SurfacePoint& s) {
    const float u = s.uv.x(), v = s.uv.y(), fp = s.footprint_m;
    const float tu = u / 0.5F, tv = v / 0.5F;
    const float tile = unit(hash(cellOf(tu), cellOf(tv), s.seed));
    float tone = 0.42F + 0.10F * (tile - 0.5F) * visible(0.5F, fp) +
                 0.08F * fractalNoise(u, v, 2.F, 0.03F, 0.8F, fp, s.seed + 3);
    const float joint =
        std::max(line(fract(tu) - 0.02F, 0.02F, fp * 2), line(fract(tv) - 0.02F, 0.02F, fp * 2));
    tone -= 0.14F * joint;
    Shade out;
    out.albedo = grey(tone).cwiseProduct(Vec3f(1.02F, 1.F, 0.96F));
    out.reflectance = 0.25F;
    return out;
}

Vec3f facadeWall(const SurfacePoint& s, float fp) {
    const float u = s.uv.x(), v = s.uv.y();
    const bool brick = unit(hash(s.seed, 1U)) < 0.45F;
    const float stain = fractalNoise(u, v, 6.4F, 0.05F, 0.75F, fp, s.seed + 13);
    if (brick) {
        const float row = std::floor(v / 0.078F);
        const float bu = u / 0.25F + 0.5F * fract(row * 0.5F) * 2.F;
        const float tint =
            unit(hash(cellOf(bu), static_cast<uint32_t>(static_cast<int32_t>(row)), s.seed));
        const float seen = visible(0.16F, fp);
        const Vec3f base =
            mix(Vec3f(0.46F, 0.24F, 0.18F), Vec3f(0.55F, 0.42F, 0.30F), unit(hash(s.seed, 2U)));
        Vec3f colour = base * (1.F + 0.45F * (tint - 0.5F) * seen + 0.30F * stain);
        const float mortar = std::max(line(fract(v / 0.078F) - 0.08F, 0.08F, fp / 0.078F),
                                      line(fract(bu) - 0.03F, 0.03F, fp / 0.25F));
        return mix(colour, grey(0.55F), 0.8F * mortar * seen + 0.12F * (1.F - seen));
    }
    const uint32_t k = hash(s.seed, 3U);
    const Vec3f base(between(k, 0.48F, 0.80F), between(hash(k, 1U), 0.46F, 0.74F),
                     between(hash(k, 2U), 0.36F, 0.66F));
    return base * (1.F + 0.30F * stain);
}

/// One cell of the window grid; returns true and the colour if the point is not wall.
bool facadeOpening(const SurfacePoint& s, float fp, Vec3f& colour, float& gloss) {
    const float cellW = between(hash(s.seed, 20U), 2.1F, 3.3F), cellH = 3.0F;
    const float cu = std::floor(s.uv.x() / cellW), cv = std::floor(s.uv.y() / cellH);
    const float u = s.uv.x() - (cu + 0.5F) * cellW, v = s.uv.y() - cv * cellH;
    const uint32_t id = hash(cellOf(cu), cellOf(cv), s.seed);
    const float kind = unit(id);
    const bool ground = cv < 0.5F;
    if (kind < (ground ? 0.18F : 0.10F)) return false;  // blind cell
    const bool door = ground && kind > 0.78F;
    const float half = door ? 0.52F : between(hash(s.seed, 21U), 0.42F, 0.68F);
    const float low = door ? 0.F : 0.95F, high = door ? 2.15F : 2.35F;
    const float mid = 0.5F * (low + high), tall = 0.5F * (high - low);
    const float du = std::abs(u) - half, dv = std::abs(v - mid) - tall;
    const float outside = std::max(du, dv);
    if (!door && std::abs(v - low + 0.06F) < 0.06F && du < 0.12F) {
        colour = grey(0.62F);  // sill
        return true;
    }
    if (outside > 0.09F) return false;
    if (outside > 0.F) {
        colour = grey(unit(hash(s.seed, 22U)) < 0.6F ? 0.78F : 0.24F);  // frame
        return true;
    }
    if (door) {
        const uint32_t d = hash(id, 5U);
        colour = Vec3f(between(d, 0.10F, 0.45F), between(hash(d, 1U), 0.10F, 0.35F),
                       between(hash(d, 2U), 0.08F, 0.30F));
        const float panel =
            line(std::abs(u) - 0.26F, 0.02F, fp) + line(fract(v / 0.7F) - 0.1F, 0.03F, fp);
        colour *= 1.F - 0.5F * std::min(1.F, panel) +
                  0.15F * fractalNoise(u, v, 0.5F, 0.03F, 0.8F, fp, id);
        return true;
    }
    if (line(u, 0.03F, fp) > 0.5F || line(v - mid - 0.35F, 0.025F, fp) > 0.5F) {
        colour = grey(0.74F);  // cross bars
        return true;
    }
    const float curtain = unit(hash(id, 7U));
    colour =
        curtain > 0.55F
            ? Vec3f(0.50F, 0.48F, 0.44F) * (1.F + 0.35F * std::sin(u * 38.F) * visible(0.16F, fp))
            : Vec3f(0.09F, 0.10F, 0.12F) * (1.F + 0.8F * valueNoise(u * 2.2F, v * 1.7F, id));
    gloss = 0.12F;
    return true;
}

Shade facade(const SurfacePoint& s) {
    Shade out;
    if (!facadeOpening(s, s.footprint_m, out.albedo, out.gloss)) {
        out.albedo = facadeWall(s, s.footprint_m);
        if (s.uv.y() < 0.5F) out.albedo *= 0.72F;  // plinth
    }
    out.reflectance = 0.35F;
    return out;
}

Shade foliage(const SurfacePoint& s) {
    const float n = fractalNoise(s.uv.x(), s.uv.y(), 0.9F, 0.02F, 0.95F, s.footprint_m, s.seed);
    const float dark =
        fractalNoise(s.uv.x(), s.uv.y(), 0.35F, 0.08F, 0.9F, s.footprint_m, s.seed + 9);
    Shade out;
    const Vec3f base =
        mix(Vec3f(0.16F, 0.25F, 0.09F), Vec3f(0.30F, 0.33F, 0.13F), unit(hash(s.seed, 4U)));
    out.albedo = base * std::max(0.15F, 1.F + 1.3F * n - (dark > 0.12F ? 0.55F : 0.F));
    out.reflectance = 0.30F;
    return out;
}

/// Windows, doors, lights, plates and paint by the position on the body.
Shade carSurface(const SurfacePoint& s) {
    const Vec3f& h = s.halfSize;
    const float fp = s.footprint_m;
    const float x = s.p_obj.x() / h.x(), y = s.p_obj.y() / h.y();  // -1 .. 1
    const float z = 0.5F * (s.p_obj.z() / h.z() + 1.F);            // 0 .. 1
    const Vec3f paint = carPaint(s.seed);
    Shade out;
    out.albedo = paint;
    out.gloss = 0.06F;
    out.reflectance = 0.25F + 0.45F * paint.mean();
    const float dirt =
        fractalNoise(s.p_obj.x() + 0.7F * s.p_obj.y(), s.p_obj.z(), 1.2F, 0.04F, 0.7F, fp, s.seed);
    out.albedo *= 1.F + 0.10F * dirt;

    const float wheel =
        std::min(std::hypot(s.p_obj.x() - s.wheelX_m, s.p_obj.z() + h.z() - s.wheelRadius_m),
                 std::hypot(s.p_obj.x() + s.wheelX_m, s.p_obj.z() + h.z() - s.wheelRadius_m));
    const bool side = std::abs(s.n_obj.y()) > 0.55F;
    const bool upper = z > 0.64F && z < 0.955F;
    const bool slanted = !side && s.n_obj.z() < 0.93F && std::abs(s.n_obj.x()) > 0.25F;
    if (side && wheel < s.wheelRadius_m + 0.07F) {
        out.albedo = grey(0.04F);
    } else if (z < 0.17F) {
        out.albedo = grey(0.08F);  // sill
    } else if (upper && side && x > -0.86F && x < 0.36F) {
        const bool pillar = line(x + 0.12F, 0.025F, fp) > 0.5F || line(x + 0.58F, 0.03F, fp) > 0.5F;
        out.albedo = pillar ? Vec3f(0.05F * Vec3f::Ones()) : Vec3f(0.055F, 0.062F, 0.07F);
        out.gloss = 0.16F;
        out.reflectance = 0.06F;
    } else if (upper && slanted && std::abs(y) < 0.80F) {
        out.albedo =
            Vec3f(0.06F, 0.07F, 0.08F) * (1.F + 0.5F * valueNoise(y * 3.F, z * 9.F, s.seed));
        out.gloss = 0.18F;
        out.reflectance = 0.06F;
    } else if (x > 0.93F && std::abs(s.p_obj.y()) < 0.26F && z > 0.24F && z < 0.34F) {
        const float glyph = unit(hash(cellOf(s.p_obj.y() / 0.055F), s.seed)) < 0.6F ? 0.15F : 0.85F;
        out.albedo = grey(0.85F - (0.85F - glyph) * visible(0.06F, fp) * 0.8F);
        out.reflectance = 0.9F;
    } else if (x < -0.93F && std::abs(s.p_obj.y()) < 0.26F && z > 0.36F && z < 0.46F) {
        const float glyph = unit(hash(cellOf(s.p_obj.y() / 0.055F), s.seed)) < 0.6F ? 0.15F : 0.80F;
        out.albedo = grey(0.80F - (0.80F - glyph) * visible(0.06F, fp) * 0.8F)
                         .cwiseProduct(Vec3f(1.F, 0.95F, 0.55F));
        out.reflectance = 0.9F;
    } else if (x > 0.84F && std::abs(y) > 0.52F && z > 0.40F && z < 0.52F) {
        out.albedo = Vec3f(0.86F, 0.87F, 0.84F);  // head lights
        out.gloss = 0.15F;
    } else if (x > 0.92F && std::abs(y) < 0.5F && z > 0.38F && z < 0.50F) {
        out.albedo =
            grey(0.07F + 0.12F * line(fract(z * 40.F) - 0.5F, 0.15F, fp * 20.F));  // grille
    } else if (x < -0.90F && std::abs(y) > 0.60F && z > 0.44F && z < 0.62F) {
        out.albedo = Vec3f(0.62F, 0.05F, 0.05F);  // tail lights
    } else if (side) {
        const float gap = std::max({line(s.p_obj.x() - 0.34F * h.x(), 0.008F, fp),
                                    line(s.p_obj.x() + 0.14F * h.x(), 0.008F, fp),
                                    line(s.p_obj.x() + 0.60F * h.x(), 0.008F, fp)});
        const float moulding = line(z - 0.40F, 0.016F, fp / h.z());
        out.albedo *= 1.F - 0.75F * gap - 0.55F * moulding;
        const float handle =
            std::abs(s.p_obj.x() + 0.06F * h.x()) < 0.08F && std::abs(z - 0.565F) < 0.014F;
        if (handle != 0.F) out.albedo = grey(0.10F);
    }
    return out;
}

}  // namespace

Vec3f carPaint(uint32_t seed) {
    static const std::array<Vec3f, 12> kPaints{
        Vec3f(0.62F, 0.07F, 0.06F), Vec3f(0.07F, 0.14F, 0.46F), Vec3f(0.78F, 0.78F, 0.76F),
        Vec3f(0.07F, 0.07F, 0.08F), Vec3f(0.46F, 0.48F, 0.50F), Vec3f(0.08F, 0.32F, 0.14F),
        Vec3f(0.78F, 0.58F, 0.06F), Vec3f(0.22F, 0.24F, 0.27F), Vec3f(0.10F, 0.38F, 0.58F),
        Vec3f(0.72F, 0.30F, 0.06F), Vec3f(0.50F, 0.44F, 0.34F), Vec3f(0.36F, 0.05F, 0.14F)};
    return kPaints.at(hash(seed, 30U) % kPaints.size());
}

Vec3f sky(const Vec3f& d) {
    const float up = std::clamp(d.z(), 0.F, 1.F);
    const float cloud = fractalNoise(3.F * d.x() / (up + 0.25F), 3.F * d.y() / (up + 0.25F), 2.F,
                                     0.1F, 0.6F, 0.02F, 4711U);
    const Vec3f blue = mix(Vec3f(0.78F, 0.84F, 0.92F), Vec3f(0.40F, 0.58F, 0.86F), std::sqrt(up));
    return mix(blue, Vec3f(0.95F, 0.95F, 0.96F), std::clamp(0.35F + 1.1F * cloud, 0.F, 1.F));
}

Shade shade(const SurfacePoint& s) {
    Shade out;
    const float fp = s.footprint_m;
    switch (s.material) {
        case Material::Asphalt:
            return asphalt(s);
        case Material::Pavement:
            return pavement(s);
        case Material::Facade:
            return facade(s);
        case Material::Foliage:
            return foliage(s);
        case Material::CarBody:
            return carSurface(s);
        case Material::Kerb:
            out.albedo =
                grey(0.50F + 0.10F * fractalNoise(s.uv.x(), s.uv.y(), 1.F, 0.03F, 0.8F, fp, 3U));
            out.albedo *= 1.F - 0.5F * line(fract(s.uv.x()) - 0.01F, 0.01F, fp);
            break;
        case Material::Grass:
            out.albedo = Vec3f(0.22F, 0.30F, 0.12F) *
                         (1.F + 0.9F * fractalNoise(s.uv.x(), s.uv.y(), 4.F, 0.02F, 0.9F, fp, 5U));
            break;
        case Material::Roof:
            out.albedo = Vec3f(0.36F, 0.20F, 0.16F) *
                         (1.F + 0.4F * fractalNoise(s.uv.x(), s.uv.y(), 1.F, 0.05F, 0.8F, fp, 6U));
            break;
        case Material::Trunk:
            out.albedo =
                Vec3f(0.24F, 0.18F, 0.13F) *
                (1.F + 0.9F * fractalNoise(6.F * s.uv.x(), s.uv.y(), 0.6F, 0.03F, 0.9F, fp, 7U));
            break;
        case Material::Metal:
            out.albedo = grey(
                0.34F + 0.10F * fractalNoise(s.uv.x(), s.uv.y(), 0.5F, 0.03F, 0.8F, fp, s.seed));
            out.reflectance = 0.5F;
            break;
        case Material::Tyre: {
            const float r = std::min(std::hypot(s.p_obj.x() - s.wheelX_m,
                                                s.p_obj.z() + s.halfSize.z() - s.wheelRadius_m),
                                     std::hypot(s.p_obj.x() + s.wheelX_m,
                                                s.p_obj.z() + s.halfSize.z() - s.wheelRadius_m));
            const bool hub = r < 0.64F * s.wheelRadius_m && std::abs(s.n_obj.y()) > 0.7F;
            out.albedo = hub ? grey(0.45F) : grey(0.045F);
            out.reflectance = hub ? 0.5F : 0.05F;
            break;
        }
    }
    return out;
}

}  // namespace djpete::simulator
