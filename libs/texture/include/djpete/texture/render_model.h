/// What a camera would see of an object model.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// Row-major, width * height; pixel (u, v) is at v * width + u.
struct RenderedModel {
    static constexpr uint32_t kNoPoint = 0xFFFFFFFF;

    int width_px = 0, height_px = 0;
    std::vector<std::array<uint8_t, 3>> rgb;  ///< black where there is no point
    std::vector<float> depth_m;               ///< z in cam; infinity where there is no point
    std::vector<uint32_t> point;              ///< index in the model, kNoPoint where there is none

    bool covered(std::size_t pixel) const { return point[pixel] != kNoPoint; }
};

struct RenderOptions {
    bool smooth = true;      ///< mean of the discs near the surface, weighted by nearness
    bool onlySeen = false;   ///< leave out points without a colour
    double discScale = 1;    ///< discs are drawn this much larger
    double maxTilt_cos = 0;  ///< points whose normal is farther from the camera are left out
};

/// Draws every point as a disc with its normal, radius and colour (not lit), nearest first. Points
/// that face away from the camera hide what is behind them and are drawn, unless maxTilt_cos is
/// above 0.
RenderedModel renderModel(const ObjectModel& model, const geometry::StereoCamera& camera,
                          const geometry::SE3& T_cam_obj,
                          const RenderOptions& options = RenderOptions());

}  // namespace djpete::texture
