/// A tiling colour texture with a mip pyramid and anisotropic filtering.
#pragma once

#include <functional>
#include <vector>

#include "mesh.h"

namespace djpete::simulator {

class Texture {
  public:
    /// Square of 2^log2_size texels covering tile_u x tile_v metres; `colourAt(u, v)` with u, v in
    /// [0, 1) gives the linear albedo factor in [0, 2] and must tile.
    Texture(int log2_size, float tile_u_m, float tile_v_m,
            const std::function<Vec3f(float, float)>& colourAt);

    /// The mean over a pixel's footprint around uv_m: an ellipse with major half axis direction
    /// `major_m` (full length, metres in uv) and width `minor_m`.
    Vec3f sample(const Vec2f& uv_m, const Vec2f& major_m, float minor_m) const;
    /// Roughly the mean over a disc; cheaper, for coarse textures.
    Vec3f sampleRound(const Vec2f& uv_m, float width_m) const;

  private:
    Vec3f trilinear(const Vec2f& uv, float level) const;
    std::uint64_t bilinear(const Vec2f& uv, int level) const;

    int levels_;
    Vec2f scale_;  // 1 / tile
    float texels_per_m_;
    std::vector<std::uint32_t> mips_;   // all levels, the finest first
    std::vector<std::size_t> firstOf_;  // of a level, in mips_
};

/// Value noise with period `period` lattice cells over [0, 1)^2, in [0, 1).
float tiledNoise(float u, float v, int period, std::uint32_t seed);
/// Octaves of tiledNoise from `period`, each of twice the frequency and `gain` times the height;
/// mean about 0.5.
float tiledFbm(float u, float v, int period, int octaves, float gain, std::uint32_t seed);

}  // namespace djpete::simulator
