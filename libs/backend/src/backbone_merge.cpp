#include "backbone_merge.h"

#include <set>
#include <vector>

namespace djpete::backend {

using geometry::SE3;
using map::KeyframeId;

namespace {

/// Keyframes after `issuedAt`, of its world, and the landmarks that begin in them.
void carryAlong(map::SlamMap& map, const SE3& T_new_old, KeyframeId issuedAt) {
    const uint32_t world = map.keyframes().at(issuedAt).world;
    std::vector<KeyframeId> later;
    for (auto it = map.keyframes().upper_bound(issuedAt); it != map.keyframes().end(); ++it) {
        if (it->second.world == world) later.push_back(it->first);
    }
    std::set<map::LandmarkId> begunLater;
    for (const KeyframeId id : later) {
        const auto& kf = map.keyframes().at(id);
        for (const auto& l : kf.landmarks) {
            if (l && map.landmarks().at(*l).observations.begin()->first > issuedAt) {
                begunLater.insert(*l);
            }
        }
        map.setKeyframePose(id, (T_new_old * kf.T_world_cam).normalised());
    }
    for (const auto id : begunLater) {
        map.setLandmarkPosition(id, T_new_old * map.landmarks().at(id).p_world);
    }
}

}  // namespace

void mergeUpdate(map::SlamMap& map, const BackboneUpdate& update, KeyframeId issuedAt,
                 BackendStatistics& statistics) {
    const SE3 before = map.keyframes().at(issuedAt).T_world_cam;
    for (const auto& [id, T_world_cam] : update.cameras) map.setKeyframePose(id, T_world_cam);
    carryAlong(map, map.keyframes().at(issuedAt).T_world_cam * before.inverse(), issuedAt);
    for (const auto& [id, p_world] : update.points) {
        if (map.landmarks().count(id) != 0) map.setLandmarkPosition(id, p_world);
    }
    for (const auto& [landmark, keyframe] : update.outliers) {
        const auto it = map.landmarks().find(landmark);
        if (it == map.landmarks().end() || it->second.observations.count(keyframe) == 0) continue;
        map.removeObservation(landmark, keyframe);
        ++statistics.outlierObservations;
    }
    for (const auto id : update.culled) {
        if (map.landmarks().count(id) == 0) continue;
        map.removeLandmark(id);
        ++statistics.landmarksCulled;
    }
}

}  // namespace djpete::backend
