#include "djpete/evaluation/camera_path.h"

#include "djpete/obs/errors.h"

namespace djpete::evaluation {

using geometry::SE3;
using obs::InputError;

namespace {

void requireFramesInside(const ObjectsFile& objects, const TrajectoryFile& estimate) {
    for (const auto& row : objects.rows) {
        const std::size_t first = objects.firstFrame;
        if (row.frame >= first && row.frame - first < estimate.poses.size()) continue;
        throw InputError(objects.path + ":" + std::to_string(row.line) + ": frame " +
                         std::to_string(row.frame) + " is not in " + estimate.path +
                         ", which has frames " + std::to_string(first) + " to " +
                         std::to_string(first + estimate.poses.size() - 1));
    }
}

}  // namespace

CameraPath estimatedCameras(const ObjectsFile& objects, const TrajectoryFile& estimate,
                            const std::optional<FrameRange>& range) {
    requireFramesInside(objects, estimate);
    CameraPath out;
    std::size_t row = 0, count = estimate.poses.size();
    out.firstFrame = objects.firstFrame;
    if (range) {
        row = firstEstimateRow(estimate, *range);
        count = range->size();
        out.firstFrame = range->begin;
        if (objects.firstFrame + row != range->begin) {
            throw InputError(objects.path + ": says that row 0 of the trajectory is frame " +
                             std::to_string(objects.firstFrame) + ", but " + estimate.path +
                             " has " + std::to_string(estimate.poses.size()) +
                             " poses, so that with this range it is frame " +
                             std::to_string(range->begin - row));
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        out.T_world_cam.push_back(objects.T_world_firstcam * estimate.poses[row + i]);
    }
    return out;
}

CameraPath trueCameras(const ObjectsFile& objects, const TrajectoryFile& truth,
                       const CameraPath& estimated, const std::optional<FrameRange>& range) {
    const std::size_t frameOfRow0 = range ? 0 : objects.firstFrame;
    const std::size_t end = estimated.firstFrame + estimated.T_world_cam.size() - frameOfRow0;
    if (truth.poses.size() < end) {
        throw InputError(truth.path + ": has " + std::to_string(truth.poses.size()) +
                         " poses; expected at least " + std::to_string(end));
    }
    const SE3 T_world_truth =
        objects.T_world_firstcam * truth.poses[objects.firstFrame - frameOfRow0].inverse();
    CameraPath out;
    out.firstFrame = estimated.firstFrame;
    for (std::size_t i = 0; i < estimated.T_world_cam.size(); ++i) {
        out.T_world_cam.push_back(T_world_truth *
                                  truth.poses[estimated.firstFrame + i - frameOfRow0]);
    }
    return out;
}

}  // namespace djpete::evaluation
