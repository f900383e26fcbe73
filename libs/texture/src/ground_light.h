/// How bright the ground around an object is: it tells whether the sun reaches the object.
/// Private: brings OpenCV.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "djpete/texture/exposure.h"
#include "occlusion.h"
#include "view_geometry.h"

namespace djpete::texture {

using Light = std::array<double, 3>;  ///< red, green, blue, linear; 1: a camera's brightest value

inline double meanOf(const Light& light) { return (light[0] + light[1] + light[2]) / 3; }

/// Light of a colour of 0..255 that a camera coded with 255 light^(1 / gamma).
Light lightOf(const std::array<float, 3>& rgb, double gamma);

/// Directions of the compass: sector k holds azimuths [k, k + 1) * 30 degrees from the world's x
/// towards its y.
constexpr std::size_t kSectors = 12;
using GroundRing = std::array<std::optional<Light>, kSectors>;

/// Collects what views show of the ground close around one object's box.
class GroundLight {
  public:
    /// `boxes`: of all objects of the view, this one's too; what they hide is left out.
    void addView(const TextureView& view, const ObjectInView& object, const ViewImage& image,
                 const DepthMap& scene, const std::vector<BoxOccluder>& boxes);
    /// Takes over the samples of what turned out to be the same object.
    void absorb(const GroundLight& other);
    /// The median of each sector on the common scale of exposures; nothing where no view saw it.
    GroundRing ring(const std::map<obs::FrameId, Exposure>& exposures, double gamma) const;

  private:
    struct Sample {
        obs::FrameId frame;
        uint32_t sector = 0;
        std::array<float, 3> rgb{0, 0, 0};
    };
    std::vector<Sample> samples_;
};

}  // namespace djpete::texture
