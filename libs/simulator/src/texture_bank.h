/// The procedural textures of all materials.
#pragma once

#include <optional>

#include "texture.h"

namespace djpete::simulator {

/// Textures are factors around 1 that a face's tint is multiplied with; their spectrum falls about
/// as 1/f, as that of real surfaces does.
class TextureBank {
  public:
    static constexpr float kWear_m = 24.F, kStains_m = 37.F;  ///< tiles of roadWear and stains
    static constexpr float kSeam_m = 4.F;                     ///< between a road's seams

    TextureBank();
    /// nullptr: the material is untextured.
    const Texture* of(Material material) const;
    /// Stains and wear over many metres.
    const Texture& stains() const { return *stains_; }
    /// Sealed cracks and wear of roads over many metres; u along the road. Seams run straight, at
    /// odd multiples of half of kSeam_m.
    const Texture& roadWear() const { return *roadWear_; }
    /// How far a seam wanders to the side at `u_m` along a street, of the street of this seed.
    float seamBend_m(float u_m, std::uint32_t seed) const;
    /// The one bank of the process; made at first use.
    static const TextureBank& shared();

  private:
    std::optional<Texture> asphalt_, pavement_, grass_, brick_, plaster_, stone_, roof_, wood_,
        bark_, stains_, roadWear_;
    std::vector<float> seamBend_m_;  // every kBendStep_m
};

}  // namespace djpete::simulator
