/// How bright the ground around an object is: it tells whether the sun reaches the object.
/// Private: brings OpenCV.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "djpete/texture/exposure.h"
#include "light.h"
#include "occlusion.h"
#include "view_geometry.h"

namespace djpete::texture {

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
