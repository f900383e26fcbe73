/// The procedural textures of all materials.
#pragma once

#include <optional>

#include "texture.h"

namespace djpete::simulator {

/// Textures are factors around 1 that a face's tint is multiplied with; their spectrum falls about
/// as 1/f, as that of real surfaces does.
class TextureBank {
  public:
    TextureBank();
    /// nullptr: the material is untextured.
    const Texture* of(Material material) const;
    /// Stains and wear over many metres.
    const Texture& stains() const { return *stains_; }
    /// Sealed cracks and wear of roads over many metres.
    const Texture& roadWear() const { return *roadWear_; }
    /// The one bank of the process; made at first use.
    static const TextureBank& shared();

  private:
    std::optional<Texture> asphalt_, pavement_, grass_, brick_, plaster_, stone_, roof_, wood_,
        bark_, stains_, roadWear_;
};

}  // namespace djpete::simulator
