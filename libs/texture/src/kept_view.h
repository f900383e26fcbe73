/// What an object keeps of a view: the part of the image that shows it. Private: brings OpenCV.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "depth_map.h"
#include "djpete/texture/object_texturer.h"
#include "occlusion.h"
#include "view_image.h"

namespace djpete::texture {

/// A colour sample of a point, packed: red, green, blue and a weight of 1..255; 0: none.
using PackedSample = uint32_t;

inline PackedSample packSample(const std::array<float, 3>& rgb, float weight) {
    const auto byte = [](float v) { return static_cast<uint32_t>(v + 0.5F) & 255U; };
    const auto w = static_cast<uint32_t>(std::min(255.0F, std::max(1.0F, 255.0F * weight)));
    return byte(rgb[0]) | (byte(rgb[1]) << 8U) | (byte(rgb[2]) << 16U) | (w << 24U);
}
inline std::array<float, 3> colourOf(PackedSample s) {
    return {static_cast<float>(s & 255U), static_cast<float>((s >> 8U) & 255U),
            static_cast<float>((s >> 16U) & 255U)};
}
inline float weightOf(PackedSample s) { return static_cast<float>(s >> 24U) / 255.0F; }

/// A cut-out of the left image, made so small that a point of the model is about two pixels wide.
struct KeptView {
    obs::FrameId frame;
    geometry::StereoCamera camera;  ///< of the cut-out
    cv::Mat
        pixels;  ///< 8UC1 (grey) or 8UC3 (blue, green, red); black: not to be used (see isOutside)
    bool masked = false;  ///< a mask said what is object
    geometry::SE3 T_cam_obj;
    float sharpness = 0;                ///< relative contrast of neighbouring pixels, per metre
    std::vector<PackedSample> samples;  ///< parallel to the model's points; may be shorter
    std::size_t sampled = 0;            ///< how many of them there are

    PackedSample sampleOf(std::size_t point) const {
        return point < samples.size() ? samples[point] : 0;
    }
    std::size_t bytes() const {
        return pixels.total() * pixels.elemSize() + samples.capacity() * sizeof(PackedSample);
    }
};

/// What tells which pixels show the object.
struct Surroundings {
    const ViewImage& image;
    const DepthMap& scene;
    cv::Mat mask;       ///< eroded, of the image's size; empty: none
    cv::Mat grownMask;  ///< dilated: what is outside it is surely not the object; empty: none
    std::vector<BoxOccluder> boxes;
};

/// Cuts the object's box out of the image. Pixels outside the mask, behind the scene's points or
/// behind other boxes are marked as not to be used; the object's depth there is that of the
/// model's points, or of its box where there is no point. Takes the samples too (see sampleView).
/// Nothing if the box is not wholly in front of the camera or not in the image.
std::optional<KeptView> cutView(const Surroundings& around, const geometry::SE3& T_cam_obj,
                                const ObjectModel& model, const TextureOptions& options);

/// For every point of the model: true if the view shows at its place what is not the object, and
/// nothing in front of it. Views without a mask say nothing.
std::vector<bool> contradicted(const ObjectModel& model, const KeptView& view);

/// Projects all points into the view and renews its samples: of points that face the camera, lie on
/// pixels that may be used and are not behind the object's own surface.
void sampleView(const ObjectModel& model, const TextureOptions& options, KeptView& view);

}  // namespace djpete::texture
