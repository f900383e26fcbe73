/// Labels put into the world and sorted by track. Private to the room.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "djpete/evaluation/camera_path.h"
#include "djpete/evaluation/object_errors.h"

namespace djpete::evaluation {

struct PlacedBox {
    geometry::SE3 T_world_obj;
    geometry::Vec3 size_m;
    bool inRange = true;
};

struct LabelTrack {
    int64_t trackId = 0;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;  ///< of its first box
    bool wanted = false;                                   ///< of a class that should be found
    bool counted = false;  ///< wanted, seen often enough, and of the motion selected
    bool moving = false;
    std::size_t framesInRange = 0;
    std::map<std::size_t, PlacedBox> boxes;  ///< by frame

    /// By central difference over one frame to both sides; nothing at gaps and ends.
    std::optional<geometry::Vec3> velocityAt(std::size_t frame, double framePeriod_s) const;
};

/// By track id; boxes of frames outside `cameras` are left out.
std::map<int64_t, LabelTrack> placeLabels(const std::vector<LabelBox>& labels,
                                          const CameraPath& cameras,
                                          const CameraPath& motionCameras,
                                          const ObjectCriteria& criteria);

/// Distance of a point in the camera's frame from the camera, as seen from above.
double horizontalRange(const geometry::Vec3& p_cam);

}  // namespace djpete::evaluation
