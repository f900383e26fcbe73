/// Seeded noise from integer hashes: the same value on every machine and in any order of calls.
#pragma once

#include <cmath>
#include <cstdint>

namespace djpete::simulator {

inline uint32_t hash(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}
inline uint32_t hash(uint32_t a, uint32_t b) { return hash(a ^ (hash(b) + 0x9e3779b9U)); }
inline uint32_t hash(uint32_t a, uint32_t b, uint32_t c) { return hash(hash(a, b), c); }
inline uint32_t hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    return hash(hash(a, b, c), d);
}
/// In [0, 1).
inline float unit(uint32_t h) { return static_cast<float>(h >> 8) * (1.F / 16777216.F); }
/// In [from, to).
inline float between(uint32_t h, float from, float to) { return from + (to - from) * unit(h); }

/// Standard normal from a hash: sum of four uniforms (bounded, smooth enough for sensor noise).
inline float gaussian(uint32_t h) {
    const float sum = unit(h) + unit(hash(h + 1)) + unit(hash(h + 2)) + unit(hash(h + 3));
    return (sum - 2.F) * 1.7320508F;
}

inline uint32_t cellOf(float x) {
    return static_cast<uint32_t>(static_cast<int32_t>(std::floor(x)));
}

/// Smooth value noise in [-1, 1] with features of size 1.
inline float valueNoise(float u, float v, uint32_t seed) {
    const float fu = std::floor(u), fv = std::floor(v);
    const auto iu = static_cast<uint32_t>(static_cast<int32_t>(fu));
    const auto iv = static_cast<uint32_t>(static_cast<int32_t>(fv));
    float du = u - fu, dv = v - fv;
    du = du * du * (3.F - 2.F * du);
    dv = dv * dv * (3.F - 2.F * dv);
    const float a = unit(hash(iu, iv, seed)), b = unit(hash(iu + 1, iv, seed));
    const float c = unit(hash(iu, iv + 1, seed)), d = unit(hash(iu + 1, iv + 1, seed));
    const float top = a + (b - a) * du, bottom = c + (d - c) * du;
    return 2.F * (top + (bottom - top) * dv) - 1.F;
}

/// How much of a pattern with this wavelength a sample of this footprint still shows: 1 .. 0.
inline float visible(float wavelength_m, float footprint_m) {
    const float x = wavelength_m / (2.F * footprint_m + 1e-6F);
    return x >= 2.F ? 1.F : (x <= 1.F ? 0.F : x - 1.F);
}

/// Octaves from `longest_m` down to `shortest_m`, amplitude falling by `gain` per octave, each
/// faded out below the footprint. Roughly in [-1, 1].
inline float fractalNoise(float u, float v, float longest_m, float shortest_m, float gain,
                          float footprint_m, uint32_t seed) {
    float sum = 0, amplitude = 1, norm = 0;
    for (float wave = longest_m; wave >= shortest_m; wave *= 0.5F) {
        norm += amplitude;
        const float w = visible(wave, footprint_m);
        if (w > 0) sum += w * amplitude * valueNoise(u / wave, v / wave, seed++);
        amplitude *= gain;
    }
    return norm > 0 ? sum / norm : 0.F;
}

}  // namespace djpete::simulator
