/// A sparse coloured cloud of what is not an object, to make a scene recognisable.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "djpete/map/slam_map.h"
#include "djpete/texture/options.h"
#include "djpete/texture/texture_view.h"

namespace djpete::texture {

struct ColouredPoint {
    float x = 0, y = 0, z = 0;  ///< metres
    std::array<uint8_t, 3> rgb{128, 128, 128};
};

/// At most one point per voxel of the world, coloured by the first view that sees it, outside the
/// boxes of all objects. From the scan, or from dense stereo at half resolution without one.
/// Deterministic; one thread.
class BackgroundCloud {
  public:
    explicit BackgroundCloud(const BackgroundCloudOptions& options = BackgroundCloudOptions());

    /// Meant for keyframes. Returns the number of points added.
    std::size_t addView(const TextureView& view);

    std::size_t size() const { return count_; }
    /// Points in `world`, each carried by the vehicle that saw it: where `map` knows its frame,
    /// from the map's present pose of that frame.
    std::vector<ColouredPoint> points(const map::SlamMap& map) const;
    /// Points in `world` by the poses the views came with.
    std::vector<ColouredPoint> points() const;

  private:
    struct ViewPoints {
        geometry::SE3 T_world_vehicle;
        std::vector<ColouredPoint> p_vehicle;
    };

    BackgroundCloudOptions options_;
    std::map<obs::FrameId, ViewPoints> views_;
    std::vector<uint64_t> occupied_;  ///< sorted voxel keys
    std::size_t count_ = 0;
};

}  // namespace djpete::texture
