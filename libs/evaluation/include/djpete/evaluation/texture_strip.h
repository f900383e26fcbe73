/// A picture to judge a model by eye.
#pragma once

#include "djpete/evaluation/texture_errors.h"

namespace djpete::evaluation {

/// The object's part of an image, six times side by side: the image; the model rendered at the
/// estimated pose; the true albedo at the true pose (times `albedoGain` in light and as the camera
/// codes it); the mask (white) with the rendering's silhouette (red, both: yellow); the difference
/// of the first two (grey: none); the model's own albedo, shown like the true one. Nothing if the
/// mesh is not in the image.
std::optional<RgbImage> textureStrip(const texture::ObjectModel& model, const TruthView& view,
                                     const TruthMesh& mesh, const RgbImage& image,
                                     const geometry::StereoCamera& camera, double albedoGain);

}  // namespace djpete::evaluation
