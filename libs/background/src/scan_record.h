/// What is kept of one keyframe: few points, few bytes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/background/options.h"
#include "djpete/texture/texture_view.h"

namespace djpete::background {

/// The end of a ray relative to the sensor, vehicle's axes, in units of kStoredUnit_m.
struct StoredPoint {
    std::array<int16_t, 3> end{};
    std::array<uint8_t, 3> rgb{};
    uint8_t flags = 0;
};
constexpr double kStoredUnit_m = 0.004;  // 16 bits reach 131 m
constexpr uint8_t kHit = 1;              // there is something at the end
constexpr uint8_t kColoured = 2;

struct ScanRecord {
    obs::FrameId frame;
    geometry::SE3 T_world_vehicle;           ///< when it was used last
    geometry::Vec3 sensor_vehicle{0, 0, 0};  ///< where the rays begin, frame vehicle
    bool fromStereo = false;
    std::vector<StoredPoint> points;
};

/// One point per cube of options.decimation_m, coloured ones first, then in the scan's order.
/// Points beyond options.max_distance_m become rays without a hit. Throws obs::InputError as
/// texture::viewPoints.
ScanRecord recordOf(const texture::TextureView& view, const OctoOptions& options);

}  // namespace djpete::background
