/// What one keyframe shows of its place.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/map/entities.h"

namespace djpete::places {

/// What one keyframe shows of its place: corners with descriptors and, where measured, points.
struct PlaceView {
    struct Corner {
        uint32_t feature = 0;  ///< index into Keyframe::features
        obs::Descriptor descriptor{};
        geometry::Vec2 px{0, 0};
        double sigma_px = 1;
        std::optional<geometry::Vec3> p_cam;  ///< by stereo and LiDAR, in cam
        double inverseDepthSigma = 0;         ///< 1/m, of 1/z; of no meaning without p_cam
    };
    map::KeyframeId id;
    geometry::StereoCamera camera;
    std::vector<Corner> corners;
};

/// The features of `keyframe` that have a descriptor, in their order. A corner has a point if its
/// inverse depth is at least three times its own sigma.
PlaceView placeView(const map::Keyframe& keyframe);

}  // namespace djpete::places
