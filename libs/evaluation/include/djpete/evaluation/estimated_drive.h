/// What a result folder of djpete-slam says of cameras and objects.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "djpete/evaluation/camera_path.h"

namespace djpete::evaluation {

/// An object of the result. Poses of the frames (keyframes) that saw it, in the run's world.
struct EstimatedObject {
    int64_t id = 0;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    geometry::Vec3 size_m{0, 0, 0};
    bool moving = false;  ///< in any of its rows
    std::map<std::size_t, geometry::SE3> T_world_obj;
};

/// Poses of objects are wrong by so much on purpose: a shift in a random direction along the ground
/// and a turn about the object's z, to a random side. Another one for each object and frame.
struct Disturbance {
    double shift_m = 0, turn_deg = 0;
    bool any() const { return shift_m != 0 || turn_deg != 0; }
};

struct EstimatedDrive {
    std::string folder;
    CameraPath cameras;
    std::map<int64_t, EstimatedObject> objects;
    std::set<std::size_t> keyframes;  ///< textures are made from these
    Disturbance disturbance;

    /// Pose at a frame: its row's; else between the rows before and after; else, if it stands, that
    /// of the nearest row; else nothing.
    std::optional<geometry::SE3> T_world_obj(int64_t object, std::size_t frame) const;
    std::optional<geometry::SE3> T_cam_obj(int64_t object, std::size_t frame) const;
};

/// Reads trajectory.kitti.txt, objects.csv and (for the keyframes) map.graph.nodes.csv. Throws
/// obs::InputError naming file and line.
EstimatedDrive readEstimatedDrive(const std::string& folder);

}  // namespace djpete::evaluation
