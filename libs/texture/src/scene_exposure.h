/// Exposure from what stands around the objects: the street looks alike in images taken shortly
/// after each other. Private: brings OpenCV.
#pragma once

#include <deque>
#include <vector>

#include "djpete/texture/exposure.h"
#include "view_geometry.h"

namespace djpete::texture {

/// Compares each image with the ones before it at points of the scene. Cars gleam differently from
/// every side; of thousands of points on roads and walls the median does not.
class SceneExposure {
  public:
    /// The next image and its scene points; returns how its brightness relates to the last images'.
    std::vector<ExposurePair> addView(const TextureView& view, const ViewImage& image,
                                      const ViewGeometry& geometry);

  private:
    struct Point {
        geometry::Vec3 p_world{0, 0, 0};
        float brightness = 0;
    };
    struct Past {
        obs::FrameId frame;
        std::vector<Point> points;
    };
    std::deque<Past> past_;
};

}  // namespace djpete::texture
