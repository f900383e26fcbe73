/// What hides an object from the camera.
#pragma once

#include <vector>

#include "djpete/texture/texture_view.h"

namespace djpete::texture {

/// The box of another object, which hides what is behind it.
class BoxOccluder {
  public:
    /// The box is grown by `margin_m`, what a pixel covers at its distance.
    BoxOccluder(const geometry::SE3& T_cam_box, const geometry::Vec3& size_m, double margin_m)
        : T_box_cam_(T_cam_box.inverse()), half_((0.5 * size_m).array() + margin_m) {}
    /// True if the line of sight to p_cam touches the box before p_cam; where boxes overlap and
    /// p_cam is inside, if more than 0.15 m of the line is. A camera inside sees everything.
    bool hides(const geometry::Vec3& p_cam) const;

  private:
    geometry::SE3 T_box_cam_;
    geometry::Vec3 half_;
};

/// The boxes of all other objects of the view that may hide object `index`. A box whose centre is
/// inside the object's own box is the same thing detected twice and hides nothing.
std::vector<BoxOccluder> occludersOf(const TextureView& view, std::size_t index);

/// The boxes of all objects of the view.
std::vector<BoxOccluder> allBoxes(const TextureView& view);

/// The share of the way along `direction` at which a line from `origin` enters the box |x| <= half;
/// nothing if it misses it or starts inside.
std::optional<double> entryShare(const geometry::Vec3& origin, const geometry::Vec3& direction,
                                 const geometry::Vec3& half);

}  // namespace djpete::texture
