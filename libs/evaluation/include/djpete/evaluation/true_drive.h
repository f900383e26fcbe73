/// What simulate-drive tells of the truth of a drive.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "djpete/evaluation/image_files.h"
#include "djpete/evaluation/trajectory_reader.h"
#include "djpete/geometry/camera.h"

namespace djpete::evaluation {

/// A labelled thing of the drive. Its poses by frame; world: the vehicle at the drive's frame 0.
struct TrueActor {
    int64_t id = 0;
    std::map<std::size_t, geometry::SE3> T_world_obj;
};

struct TrueDrive {
    std::string folder;
    geometry::StereoCamera camera;  ///< left colour camera (image_2)
    TrajectoryFile cameras;         ///< T_cam0_cam of frame 0, 1, ...
    geometry::SE3 T_cam_vehicle;
    std::map<int64_t, TrueActor> actors;
    /// Towards the sun, world, unit: the simulator's own, turned by sun-turn-rad of
    /// drive_options.txt; nothing without that file.
    std::optional<geometry::Vec3> sun_world;

    /// Nothing if the actor is not near in that frame or the drive has no such frame.
    std::optional<geometry::SE3> T_cam_obj(int64_t actor, std::size_t frame) const;
    std::string imageFile(std::size_t frame) const;     ///< image_2/NNNNNN.png
    std::string instanceFile(std::size_t frame) const;  ///< instances/NNNNNN.png
    std::string meshFile(int64_t actor) const;          ///< objects/NNN.ply
};

/// Reads calib.txt, poses.txt and objects.txt of a folder that simulate-drive made with colour
/// images. Throws obs::InputError naming file and line. The left colour camera must be where the
/// poses are (as the simulator has it).
TrueDrive readTrueDrive(const std::string& folder);

}  // namespace djpete::evaluation
