#include "texture_bank.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "parallel.h"

namespace djpete::simulator {
namespace {

float ramp(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.F, 1.F);
    return t * t * (3.F - 2.F * t);
}
float fraction(float x) { return x - std::floor(x); }
Vec3f grey(float v) { return Vec3f::Constant(v); }

/// Dark wandering lines where two warped noises cross their middle.
float cracks(float u, float v, int period, float width, std::uint32_t seed) {
    const float n = tiledFbm(u, v, period, 5, 0.55F, seed);
    const float gate = ramp(0.42F, 0.62F, tiledNoise(u, v, period, seed + 77));
    return gate * (1.F - ramp(0.F, width, std::abs(n - 0.5F)));
}

/// Distance to the border between irregular cells, `period` of them over the tile, in cells.
float cellBorder(float u, float v, int period, std::uint32_t seed) {
    const float x = u * static_cast<float>(period), y = v * static_cast<float>(period);
    float nearest = 9.F, second = 9.F;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const float cx = std::floor(x) + static_cast<float>(i),
                        cy = std::floor(y) + static_cast<float>(j);
            // tiledNoise at a lattice point is that point's own random number.
            const float jx = tiledNoise(cx / static_cast<float>(period),
                                        cy / static_cast<float>(period), period, seed);
            const float jy = tiledNoise(cx / static_cast<float>(period),
                                        cy / static_cast<float>(period), period, seed + 1);
            const float d = std::hypot(cx + jx - x, cy + jy - y);
            second = std::min(second, std::max(nearest, d));
            nearest = std::min(nearest, d);
        }
    }
    return second - nearest;
}

/// Grit in bitumen: grains of all sizes up to a few centimetres, little beyond.
Vec3f asphalt(float u, float v) {
    const float stones = tiledNoise(u, v, 512, 1) - 0.5F, gravel = tiledNoise(u, v, 200, 2) - 0.5F;
    const float grit = tiledFbm(u, v, 64, 4, 1.F, 3) - 0.5F;
    const float body = tiledFbm(u, v, 4, 4, 0.8F, 6) - 0.5F;
    const float bright = ramp(0.84F, 0.95F, tiledNoise(u, v, 170, 4));
    const float dark = ramp(0.82F, 0.94F, tiledNoise(u, v, 110, 5));
    return grey(1.F + 0.5F * stones + 0.55F * gravel + 0.8F * grit + 0.16F * body + 0.5F * bright -
                0.3F * dark);
}

/// What years do to a road of 24 m: cracks sealed with tar, seams along it, wear and oil.
Vec3f wearPattern(float u, float v) {
    float tar = 0;
    const float open = ramp(0.50F, 0.66F, tiledFbm(u, v, 5, 2, 0.5F, 123));
    if (open > 0.1F) {
        const float bendU = tiledFbm(u, v, 6, 4, 0.6F, 111) - 0.5F,
                    bendV = tiledFbm(u, v, 6, 4, 0.6F, 117) - 0.5F;
        const float width = 0.024F * open * (0.6F + 0.8F * (bendU + 0.5F));
        const float net = cellBorder(u + 0.07F * bendU, v + 0.07F * bendV, 9, 121);
        tar = 1.F - ramp(0.7F * width, 1.3F * width, net);
    }
    // Seams every 4 m, sealed here and there.
    const float lane = v * (TextureBank::kWear_m / TextureBank::kSeam_m);
    const auto seam = static_cast<std::uint32_t>(static_cast<int>(std::floor(lane)) + 6) % 6U;
    const float off = std::abs(fraction(lane) - 0.5F);
    if (off < 0.02F)
        tar = std::max(tar, ramp(0.45F, 0.55F, tiledNoise(u, 0.F, 5, 140U + seam)) *
                                (1.F - ramp(0.0075F, 0.0125F, off)));
    const float body = tiledFbm(u, v, 6, 5, 0.6F, 101) - 0.5F;
    const float patch = ramp(0.62F, 0.65F, tiledFbm(u, v, 7, 3, 0.5F, 107));
    return grey((1.F + 0.38F * body - 0.10F * patch) * (1.F - 0.55F * tar));
}

/// Concrete slabs of 0.3 m with thin joints, half a slab shifted every other row.
Vec3f pavement(float u, float v) {
    const float row = std::floor(v * 10.F), x = u * 10.F + 0.5F * std::fmod(row, 2.F), y = v * 10.F;
    const float edge = std::min({fraction(x), 1 - fraction(x), fraction(y), 1 - fraction(y)});
    const float joint = 1.F - ramp(0.012F, 0.04F, edge);
    const float slab =
        tiledNoise((std::fmod(std::floor(x), 10.F) + 0.5F) / 10.F, (row + 0.5F) / 10.F, 10, 21);
    const float body = tiledFbm(u, v, 8, 7, 0.7F, 22) - 0.5F,
                grain = tiledNoise(u, v, 256, 23) - 0.5F;
    return grey((0.86F + 0.10F * slab + 0.36F * body + 0.16F * grain) * (1.F - 0.4F * joint));
}

Vec3f grass(float u, float v) {
    const float blades = tiledNoise(u, v, 256, 31) - 0.5F,
                tufts = tiledFbm(u, v, 6, 6, 0.75F, 32) - 0.5F;
    const float dry = ramp(0.5F, 0.75F, tiledFbm(u, v, 5, 4, 0.6F, 35));
    const float value = 1.F + 0.7F * blades + 1.5F * tufts;
    return value * (Vec3f::Ones() + dry * Vec3f(0.6F, 0.2F, 0.1F));
}

Vec3f brick(float u, float v) {
    // 8 bricks of 0.24 m by 24 courses of 0.08 m.
    const float course = std::floor(v * 24.F), y = v * 24.F;
    const float x = u * 8.F + 0.5F * std::fmod(course, 2.F);
    const float dx = std::min(fraction(x), 1.F - fraction(x)) * 0.24F;
    const float dy = std::min(fraction(y), 1.F - fraction(y)) * 0.08F;
    const float mortar = 1.F - ramp(0.004F, 0.008F, std::min(dx, dy));
    const float tone =
        tiledNoise((std::fmod(std::floor(x), 8.F) + 0.5F) / 8.F, (course + 0.5F) / 24.F, 192, 41);
    const float body = tiledFbm(u, v, 16, 6, 0.75F, 42) - 0.5F;
    const Vec3f stone = (0.78F + 0.44F * tone + 0.5F * body) * Vec3f::Ones();
    return stone + mortar * (Vec3f(1.05F, 1.35F, 1.5F) * (1.F + 0.5F * body) - stone);
}

Vec3f plaster(float u, float v) {
    const float grain = tiledNoise(u, v, 512, 51) - 0.5F,
                body = tiledFbm(u, v, 3, 8, 0.66F, 52) - 0.5F;
    const float streak =
        ramp(0.5F, 0.8F, tiledFbm(u, 0.13F * v, 32, 4, 0.6F, 53)) * tiledNoise(u, v, 4, 54);
    return grey((1.F + 0.22F * grain + 0.42F * body) * (1.F - 0.12F * streak) *
                (1.F - 0.2F * cracks(u, v, 4, 0.003F, 55)));
}

Vec3f stone(float u, float v) {
    const float course = std::floor(v * 8.F), y = v * 8.F;
    const float x = u * 6.F + 0.37F * course;
    const float dx = std::min(fraction(x), 1.F - fraction(x)),
                dy = std::min(fraction(y), 1.F - fraction(y));
    const float wobble = 0.03F * (tiledNoise(u, v, 32, 61) - 0.5F);
    const float joint = 1.F - ramp(0.02F, 0.06F, std::min(dx * 1.3F, dy) + wobble);
    const float tone = tiledNoise(fraction((std::floor(x) - 0.37F * course + 0.5F) / 6.F),
                                  (course + 0.5F) / 8.F, 48, 62);
    const float body = tiledFbm(u, v, 8, 7, 0.75F, 63) - 0.5F;
    return grey((0.82F + 0.36F * tone + 0.7F * body) * (1.F - 0.45F * joint));
}

Vec3f roof(float u, float v) {
    const float row = std::floor(v * 8.F), y = fraction(v * 8.F),
                x = u * 10.F + 0.5F * std::fmod(row, 2.F);
    const float round = std::abs(fraction(x) - 0.5F) * 2.F;
    const float tone =
        tiledNoise((std::fmod(std::floor(x), 10.F) + 0.5F) / 10.F, (row + 0.5F) / 8.F, 80, 71);
    const float body = tiledFbm(u, v, 8, 6, 0.7F, 72) - 0.5F;
    return grey((0.75F + 0.5F * tone + 0.6F * body) * (0.55F + 0.45F * ramp(0.F, 0.25F, y)) *
                (1.F - 0.35F * round * round));
}

Vec3f wood(float u, float v) {
    const float plank = std::floor(u * 8.F),
                edge = std::min(fraction(u * 8.F), 1.F - fraction(u * 8.F));
    const float tone = tiledNoise((plank + 0.5F) / 8.F, 0.5F, 8, 81);
    const float grain = tiledFbm(u, 0.06F * v, 64, 4, 0.7F, 82) - 0.5F;
    return grey((0.8F + 0.4F * tone + 0.6F * grain) *
                (1.F - 0.5F * (1.F - ramp(0.02F, 0.06F, edge))));
}

Vec3f bark(float u, float v) {
    const float ridges = tiledFbm(u, 0.25F * v, 32, 5, 0.7F, 91) - 0.5F;
    return grey(1.F + 1.6F * ridges + 0.5F * (tiledNoise(u, v, 64, 92) - 0.5F));
}

constexpr int kBends = 4096;  // samples of the way of seams, a power of two
constexpr float kBendStep_m = 0.05F;

Vec3f stainPattern(float u, float v) {
    const float body = tiledFbm(u, v, 4, 6, 0.62F, 101) - 0.5F;
    const float patch = ramp(0.56F, 0.60F, tiledFbm(u, v, 7, 3, 0.5F, 107));
    return grey(1.F + 0.6F * body - 0.07F * patch);
}

}  // namespace

TextureBank::TextureBank() {
    for (int i = 0; i < kBends; ++i)
        seamBend_m_.push_back(
            0.07F * kSeam_m *
            (tiledFbm(static_cast<float>(i) / kBends, 0.5F, 64, 5, 0.65F, 131U) - 0.5F));
    struct Recipe {
        std::optional<Texture>* texture;
        int log2_size;
        float tile_m;
        Vec3f (*pattern)(float, float);
    };
    const std::vector<Recipe> recipes{{&asphalt_, 10, 4.F, asphalt},
                                      {&plaster_, 10, 4.F, plaster},
                                      {&brick_, 10, 1.92F, brick},
                                      {&pavement_, 9, 3.F, pavement},
                                      {&grass_, 9, 3.F, grass},
                                      {&stone_, 9, 2.4F, stone},
                                      {&roof_, 9, 2.4F, roof},
                                      {&stains_, 9, kStains_m, stainPattern},
                                      {&wood_, 8, 1.F, wood},
                                      {&bark_, 8, 1.F, bark},
                                      {&roadWear_, 10, kWear_m, wearPattern}};
    parallelFor(static_cast<int>(recipes.size()), std::max(1U, std::thread::hardware_concurrency()),
                [&](int i) {
                    const Recipe& r = recipes[static_cast<std::size_t>(i)];
                    r.texture->emplace(r.log2_size, r.tile_m, r.tile_m, r.pattern);
                });
}

const Texture* TextureBank::of(Material material) const {
    switch (material) {
        case Material::Asphalt:
            return &*asphalt_;
        case Material::Pavement:
            return &*pavement_;
        case Material::Kerb:
        case Material::Stone:
            return &*stone_;
        case Material::Grass:
            return &*grass_;
        case Material::Brick:
            return &*brick_;
        case Material::Plaster:
            return &*plaster_;
        case Material::Roof:
            return &*roof_;
        case Material::Wood:
            return &*wood_;
        case Material::Trunk:
            return &*bark_;
        default:
            return nullptr;
    }
}

float TextureBank::seamBend_m(float u_m, std::uint32_t seed) const {
    const float x = u_m / kBendStep_m, whole = std::floor(x), f = x - whole;
    const std::uint32_t i = static_cast<std::uint32_t>(static_cast<std::int32_t>(whole)) + seed;
    const float a = seamBend_m_[i % kBends], b = seamBend_m_[(i + 1U) % kBends];
    return a + f * (b - a);
}

const TextureBank& TextureBank::shared() {
    static const TextureBank bank;
    return bank;
}

}  // namespace djpete::simulator
