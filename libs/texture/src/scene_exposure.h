/// Exposure from what stands around the objects: the street looks alike in images taken shortly
/// after each other. Private: brings OpenCV.
#pragma once

#include <deque>
#include <vector>

#include "djpete/texture/exposure.h"
#include "view_geometry.h"

namespace djpete::texture {

/// Compares each image with the ones before it at points of the scene. Cars gleam differently from
/// every side; of thousands of points on roads and walls the median does not. What comes nearer
/// moves outwards, where lenses are darker: without regard to that, gains would fall from image to
/// image.
class SceneExposure {
  public:
    /// The next image and its scene points; returns how its brightness relates to the last images'.
    std::vector<ExposurePair> addView(const TextureView& view, const ViewImage& image,
                                      const ViewGeometry& geometry);

  private:
    struct Point {
        geometry::Vec3 p_world{0, 0, 0};
        float brightness = 0;
        float radius2 = 0;  ///< squared distance from the image's centre; 1 in its corners
    };
    /// What two images show of a point.
    struct Comparison {
        double logRatio = 0, outwards = 0;  ///< before / now; growth of radius2
    };
    void learnVignetting(std::vector<Comparison>& seen);
    struct Past {
        obs::FrameId frame;
        std::vector<Point> points;
    };
    std::deque<Past> past_;
    double slopes_ = 0, slopeWeights_ = 0;  ///< sums over all pairs of images so far
};

}  // namespace djpete::texture
