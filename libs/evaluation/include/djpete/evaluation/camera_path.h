/// Camera poses by frame number, in the world of an object file.
#pragma once

#include <cstddef>
#include <optional>

#include "djpete/evaluation/frame_range.h"
#include "djpete/evaluation/objects_csv.h"

namespace djpete::evaluation {

/// T_world_cam of frames firstFrame, firstFrame + 1, ...
struct CameraPath {
    std::size_t firstFrame = 0;
    Trajectory T_world_cam;

    bool contains(std::size_t frame) const {
        return frame >= firstFrame && frame - firstFrame < T_world_cam.size();
    }
    const geometry::SE3& at(std::size_t frame) const { return T_world_cam.at(frame - firstFrame); }
};

/// The run's own cameras: T_world_firstcam * row(f - first_frame), for all frames or those of the
/// range. Throws obs::InputError if an object's frame lies outside the trajectory, or the range and
/// the file's first_frame contradict each other.
CameraPath estimatedCameras(const ObjectsFile& objects, const TrajectoryFile& estimate,
                            const std::optional<FrameRange>& range);

/// The true cameras for the same frames as `estimated`, placed so that they meet the run's first
/// camera: T_world_firstcam * truth(first_frame)^-1 * truth(f). With a range, truth row f is frame
/// f; without one, truth row i is frame first_frame + i. Throws obs::InputError if truth is too
/// short.
CameraPath trueCameras(const ObjectsFile& objects, const TrajectoryFile& truth,
                       const CameraPath& estimated, const std::optional<FrameRange>& range);

}  // namespace djpete::evaluation
