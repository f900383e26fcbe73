/// What one frame brings to the textures.
#pragma once

#include <optional>
#include <vector>

#include "djpete/map/entities.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::texture {

/// An object as it stands at the stamp of a view.
struct ObjectInView {
    map::ObjectId id;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    geometry::Vec3 size_m{0, 0, 0};  ///< (length, width, height)
    geometry::SE3 T_world_obj;       ///< at this stamp, so that moving objects work alike
    /// In the view's left image; a mask of another size than the image is an InputError.
    std::optional<obs::RleMask> mask;
};

/// One frame: images, scan and all objects near it. Objects that hide others belong in the list
/// even if they are not to be textured well.
struct TextureView {
    obs::FrameId frame;
    obs::ImageSet images;           ///< the left one gives the colours
    geometry::SE3 T_world_cam;      ///< of the left camera of `images`
    geometry::SE3 T_world_vehicle;  ///< carries the scan: T_world_velo = it * scan.T_vehicle_velo
    std::optional<obs::LidarScan> scan;
    std::vector<ObjectInView> objects;
};

}  // namespace djpete::texture
