#include "label_tracks.h"

#include <cmath>

namespace djpete::evaluation {

using geometry::Vec3;

double horizontalRange(const Vec3& p_cam) { return std::hypot(p_cam.x(), p_cam.z()); }

std::optional<Vec3> LabelTrack::velocityAt(std::size_t frame, double framePeriod_s) const {
    if (frame == 0) return std::nullopt;
    const auto before = boxes.find(frame - 1), after = boxes.find(frame + 1);
    if (before == boxes.end() || after == boxes.end()) return std::nullopt;
    return (after->second.T_world_obj.translation() - before->second.T_world_obj.translation()) /
           (2 * framePeriod_s);
}

std::map<int64_t, LabelTrack> placeLabels(const std::vector<LabelBox>& labels,
                                          const CameraPath& cameras,
                                          const CameraPath& motionCameras,
                                          const ObjectCriteria& criteria) {
    std::map<int64_t, LabelTrack> tracks;
    std::map<int64_t, std::map<std::size_t, Vec3>> motionPaths;
    for (const auto& label : labels) {
        if (!cameras.contains(label.frame)) continue;
        auto [it, isNew] = tracks.try_emplace(label.trackId);
        LabelTrack& track = it->second;
        if (isNew) {
            track.trackId = label.trackId;
            track.objectClass = label.objectClass;
            track.wanted = criteria.classes.count(label.objectClass) > 0;
        }
        PlacedBox box{cameras.at(label.frame) * label.T_cam_obj, label.size_m, true};
        if (criteria.maxRange_m) {
            box.inRange = horizontalRange(label.T_cam_obj.translation()) <= *criteria.maxRange_m;
        }
        track.framesInRange += box.inRange ? 1 : 0;
        track.boxes[label.frame] = box;
        if (motionCameras.contains(label.frame)) {
            motionPaths[label.trackId][label.frame] =
                motionCameras.at(label.frame) * label.T_cam_obj.translation();
        }
    }
    for (auto& [id, track] : tracks) {
        const auto& path = motionPaths[id];
        for (const auto& [frame, p_world] : path) {
            const double moved_m = (p_world - path.begin()->second).norm();
            track.moving = track.moving || moved_m >= criteria.staticBelow_m;
        }
        const bool motionFits = criteria.motion == MotionSelection::All ||
                                (criteria.motion == MotionSelection::MovingOnly) == track.moving;
        track.counted = track.wanted && motionFits && track.framesInRange >= criteria.minFrames;
    }
    return tracks;
}

}  // namespace djpete::evaluation
