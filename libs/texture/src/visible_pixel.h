/// Where an image shows a point of the scene. Private: brings OpenCV.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "depth_map.h"
#include "occlusion.h"
#include "view_image.h"

namespace djpete::texture {

/// Pixel of p_cam (metres, before the camera); nothing outside the image, behind the scene's points
/// or behind a box.
inline std::optional<geometry::Vec2> visiblePixel(const geometry::Vec3& p_cam,
                                                  const ViewImage& image, const DepthMap& scene,
                                                  const std::vector<BoxOccluder>& boxes) {
    constexpr double kBehind_m = 0.3;
    const geometry::Vec2 uv = image.camera.project(p_cam);
    if (!image.camera.contains(uv, 2)) return std::nullopt;
    const double front = static_cast<double>(
        scene.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y()))));
    // Neighbouring beams on sloping ground are a share of the depth apart.
    if (p_cam.z() > 1.05 * front + kBehind_m) return std::nullopt;
    for (const BoxOccluder& box : boxes) {
        if (box.hides(p_cam)) return std::nullopt;
    }
    return uv;
}

}  // namespace djpete::texture
