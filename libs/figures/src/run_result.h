/// What a run left in its folder, and the drive it came from.
#pragma once

#include <map>
#include <opencv2/core.hpp>

#include "djpete/evaluation/camera_path.h"
#include "djpete/evaluation/trajectory_reader.h"
#include "djpete/figures/figures.h"
#include "djpete/obs/sensor_frame.h"
#include "djpete/texture/object_model.h"

namespace djpete::figures {

struct RunResult {
    evaluation::TrajectoryFile trajectory;  ///< firstcam <- cam
    evaluation::ObjectsFile objects;
    evaluation::CameraPath cameras;  ///< T_world_cam of the main camera
    std::map<int64_t, texture::ObjectModel> models;

    /// Ids of textured objects with the most coloured points, at most `count`.
    std::vector<int64_t> best(std::size_t count) const;
};

/// Throws obs::InputError naming the file that is missing or broken. No textured objects are fine.
RunResult readResult(const std::string& folder);

/// A frame of the drive with what it shows.
struct ShownFrame {
    std::size_t frame = 0;
    cv::Mat image;                  ///< colour if there is any (see ShownImage)
    geometry::StereoCamera camera;  ///< of `image`
    geometry::SE3 T_world_cam;      ///< of `image`
    geometry::SE3 T_world_vehicle;
    std::optional<obs::LidarScan> scan;
};

/// Frames `wanted` of the drive, as the run placed them; those that the drive lacks, or that show
/// no image, are absent. Also the truth that the drive carries: T_world_cam per frame.
struct DriveFrames {
    std::map<std::size_t, ShownFrame> shown;
    std::map<std::size_t, geometry::SE3> trueCameras;
};
enum class ShownImage { Texture, Main };  ///< Main: that of the cameras' path, grey if there is one
DriveFrames readDrive(const std::string& rawlog, const evaluation::CameraPath& cameras,
                      const std::vector<std::size_t>& wanted,
                      ShownImage which = ShownImage::Texture);

}  // namespace djpete::figures
