/// One object takes its colours from one view. Private: brings OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "depth_map.h"
#include "djpete/texture/object_texturer.h"
#include "view_image.h"

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

struct ColouringView {
    const ViewImage& image;
    const DepthMap& scene;
    cv::Mat mask;  ///< eroded; empty: none
    std::vector<BoxOccluder> boxes;
    geometry::SE3 T_cam_obj;
};

/// Adds a sample to every point that the view sees, and sets the cloud's colours.
ViewReport colourObject(const ColouringView& view, const TextureOptions& options,
                        ObjectModel& model);

}  // namespace djpete::texture
