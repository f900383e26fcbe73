#include "texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace djpete::simulator {
namespace {

constexpr float kCode = 127.5F;  // stored byte = kCode * factor, so factors reach 2

std::uint32_t packed(const Vec3f& c) {
    const Vec3f b = (kCode * c).array().max(0.F).min(255.F) + 0.49F;
    return static_cast<std::uint32_t>(b[0]) | (static_cast<std::uint32_t>(b[1]) << 8) |
           (static_cast<std::uint32_t>(b[2]) << 16);
}

/// Four bytes to four 16-bit lanes.
std::uint64_t spread(std::uint32_t v) {
    std::uint64_t x = v;
    x = (x | (x << 16)) & 0x0000FFFF0000FFFFULL;
    return (x | (x << 8)) & 0x00FF00FF00FF00FFULL;
}

std::uint64_t lerp(std::uint64_t a, std::uint64_t b, std::uint64_t weight256) {
    return ((a * (256 - weight256) + b * weight256) >> 8) & 0x00FF00FF00FF00FFULL;
}

/// Lanes to albedo factors.
Vec3f unpacked(std::uint64_t c) {
    return Vec3f(static_cast<float>(c & 0xFFFF), static_cast<float>((c >> 16) & 0xFFFF),
                 static_cast<float>((c >> 32) & 0xFFFF)) *
           (1.F / kCode);
}

/// For values within the range of int; without a call of the C library.
std::int32_t floorOf(float x) {
    const auto whole = static_cast<std::int32_t>(x);
    return static_cast<float>(whole) > x ? whole - 1 : whole;
}
/// x - floor(x)
float fractionOf(float x) { return x - static_cast<float>(floorOf(x)); }

/// Within 0.01 of log2(x), for x > 0; the same on every machine.
float roughLog2(float x) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 127);
    const float m = static_cast<float>(bits & 0x7FFFFFU) * (1.F / 8388608.F);  // mantissa - 1
    return exponent + m * (1.3465F - 0.3465F * m);
}

std::uint32_t latticeHash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    std::uint32_t h = x * 0x8DA6B343U ^ y * 0xD8163841U ^ seed * 0xCB1AB31FU;
    h ^= h >> 15;
    h *= 0x2C1B3C6DU;
    h ^= h >> 12;
    h *= 0x297A2D39U;
    return h ^ (h >> 15);
}

}  // namespace

float tiledNoise(float u, float v, int period, std::uint32_t seed) {
    const float x = u * static_cast<float>(period), y = v * static_cast<float>(period);
    const std::int32_t fx = floorOf(x), fy = floorOf(y);
    // Divisions are slow, and most lattice cells lie within the tile anyway.
    const auto wrap = [period](int i) {
        const bool within = i >= 0 && i < period;
        return static_cast<std::uint32_t>(within ? i : ((i % period) + period) % period);
    };
    const auto next = [period](std::uint32_t i) {
        return i + 1 == static_cast<std::uint32_t>(period) ? 0U : i + 1;
    };
    const std::uint32_t x0 = wrap(fx), x1 = next(x0);
    const std::uint32_t y0 = wrap(fy), y1 = next(y0);
    const auto value = [seed](std::uint32_t i, std::uint32_t j) {
        return static_cast<float>(latticeHash(i, j, seed) >> 8) * (1.F / 16777216.F);
    };
    const auto smooth = [](float t) { return t * t * (3.F - 2.F * t); };
    const float sx = smooth(x - static_cast<float>(fx)), sy = smooth(y - static_cast<float>(fy));
    const float low = value(x0, y0) + sx * (value(x1, y0) - value(x0, y0));
    const float high = value(x0, y1) + sx * (value(x1, y1) - value(x0, y1));
    return low + sy * (high - low);
}

float tiledFbm(float u, float v, int period, int octaves, float gain, std::uint32_t seed) {
    float sum = 0, weight = 1, total = 0;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * tiledNoise(u, v, period << i, seed + static_cast<std::uint32_t>(i));
        total += weight;
        weight *= gain;
    }
    return sum / total;
}

Texture::Texture(int log2_size, float tile_u_m, float tile_v_m,
                 const std::function<Vec3f(float, float)>& colourAt)
    : levels_(log2_size + 1), scale_(1.F / tile_u_m, 1.F / tile_v_m) {
    const std::size_t size = std::size_t{1} << log2_size;
    texels_per_m_ = static_cast<float>(size) / std::max(tile_u_m, tile_v_m);
    std::vector<Vec3f> level(size * size);
    mips_.reserve(size * size * 4 / 3 + 1);
    for (std::size_t y = 0; y < size; ++y)
        for (std::size_t x = 0; x < size; ++x)
            level[y * size + x] =
                colourAt((static_cast<float>(x) + 0.5F) / static_cast<float>(size),
                         (static_cast<float>(y) + 0.5F) / static_cast<float>(size));
    for (std::size_t n = size;; n /= 2) {
        firstOf_.push_back(mips_.size());
        for (const auto& texel : level) mips_.push_back(packed(texel));
        if (n == 1) break;
        const std::size_t half = n / 2;
        std::vector<Vec3f> coarse(half * half);
        for (std::size_t y = 0; y < half; ++y)
            for (std::size_t x = 0; x < half; ++x)
                coarse[y * half + x] =
                    0.25F * (level[2 * y * n + 2 * x] + level[2 * y * n + 2 * x + 1] +
                             level[(2 * y + 1) * n + 2 * x] + level[(2 * y + 1) * n + 2 * x + 1]);
        level = std::move(coarse);
    }
}

std::uint64_t Texture::bilinear(const Vec2f& uv, int level) const {
    const int log2_n = levels_ - 1 - level;
    const auto n = static_cast<float>(1 << log2_n);
    const std::int32_t mask = (1 << log2_n) - 1;
    // 24.8 fixed point; the subtraction of half a texel puts centres at integers.
    const auto x = floorOf((uv.x() * n - 0.5F) * 256.F + 0.5F);
    const auto y = floorOf((uv.y() * n - 0.5F) * 256.F + 0.5F);
    const auto x0 = static_cast<std::size_t>((x >> 8) & mask);
    const auto x1 = static_cast<std::size_t>(((x >> 8) + 1) & mask);
    const auto row0 = static_cast<std::size_t>((y >> 8) & mask) << log2_n;
    const auto row1 = static_cast<std::size_t>(((y >> 8) + 1) & mask) << log2_n;
    const std::uint32_t* mip = mips_.data() + firstOf_[static_cast<std::size_t>(level)];
    const auto wx = static_cast<std::uint64_t>(x & 255), wy = static_cast<std::uint64_t>(y & 255);
    return lerp(lerp(spread(mip[row0 + x0]), spread(mip[row0 + x1]), wx),
                lerp(spread(mip[row1 + x0]), spread(mip[row1 + x1]), wx), wy);
}

Vec3f Texture::trilinear(const Vec2f& uv, float level) const {
    const float clamped = std::clamp(level, 0.F, static_cast<float>(levels_ - 1));
    const int low = static_cast<int>(clamped);
    // Levels blend over the middle half of a step only: mostly one will do.
    const float weight = std::clamp(2.F * (clamped - static_cast<float>(low)) - 0.5F, 0.F, 1.F);
    const auto weight256 = static_cast<std::uint64_t>(weight * 256.F);
    if (weight256 == 0) return unpacked(bilinear(uv, low));
    if (weight256 == 256) return unpacked(bilinear(uv, low + 1));
    return unpacked(lerp(bilinear(uv, low), bilinear(uv, low + 1), weight256));
}

Vec3f Texture::sample(const Vec2f& uv_m, const Vec2f& major_m, float minor_m) const {
    constexpr int kMaxTaps = 5;
    const Vec2f tiles = uv_m.cwiseProduct(scale_);
    // Wrapped, which keeps the fixed point small.
    const Vec2f uv(fractionOf(tiles.x()), fractionOf(tiles.y()));
    // In texels; below one there is nothing to filter.
    const float major = major_m.norm() * texels_per_m_;
    const float minor = std::max(minor_m * texels_per_m_, 1.F);
    const int taps = std::clamp(static_cast<int>(major / minor + 0.5F), 1, kMaxTaps);
    const float width = std::max(minor, major / static_cast<float>(taps));
    const float level = width <= 1.F ? 0.F : roughLog2(width);
    if (taps == 1) return trilinear(uv, level);
    // Taps overlap the levels' steps, so the nearest level will do.
    const int nearest = std::min(static_cast<int>(level + 0.5F), levels_ - 1);
    const Vec2f step = major_m.cwiseProduct(scale_) / static_cast<float>(taps);
    std::uint64_t sum = 0;  // lanes of 16 bits hold up to 257 taps
    for (int i = 0; i < taps; ++i)
        sum += bilinear(uv + step * (static_cast<float>(i) - 0.5F * static_cast<float>(taps - 1)),
                        nearest);
    return unpacked(sum) / static_cast<float>(taps);
}

Vec3f Texture::sampleRound(const Vec2f& uv_m, float width_m) const {
    const Vec2f tiles = uv_m.cwiseProduct(scale_);
    const float width = width_m * texels_per_m_;
    const float level = width <= 1.F ? 0.F : roughLog2(width);
    return unpacked(bilinear(Vec2f(fractionOf(tiles.x()), fractionOf(tiles.y())),
                             std::min(static_cast<int>(level + 0.5F), levels_ - 1)));
}

}  // namespace djpete::simulator
