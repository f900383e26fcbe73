#include "loop_keeper.h"

#include <algorithm>
#include <map>

namespace djpete::backend {

using geometry::Mat6;
using geometry::SE3;
using map::KeyframeId;
using map::LandmarkId;
using map::SlamMap;

namespace {

/// Where the claim puts the newer camera, in the older one's world.
SE3 claimedPose(const SlamMap& map, KeyframeId older, const SE3& T_older_newer) {
    return map.keyframes().at(older).T_world_cam * T_older_newer;
}

/// Moves keyframes to new poses; a landmark goes with the keyframe that saw it first.
void moveAll(SlamMap& map, const std::map<KeyframeId, SE3>& T_world_cam) {
    std::vector<std::pair<LandmarkId, geometry::Vec3>> points;
    for (const auto& [id, landmark] : map.landmarks()) {
        if (landmark.observations.empty()) continue;
        const auto moved = T_world_cam.find(landmark.observations.begin()->first);
        if (moved == T_world_cam.end()) continue;
        const SE3 T_cam_world = map.keyframes().at(moved->first).T_world_cam.inverse();
        points.emplace_back(id, moved->second * (T_cam_world * landmark.p_world));
    }
    for (const auto& [id, p_world] : points) map.setLandmarkPosition(id, p_world);
    for (const auto& [id, pose] : T_world_cam) map.setKeyframePose(id, pose);
}

/// The newer of the two worlds becomes part of the older one.
void joinWorlds(SlamMap& map, KeyframeId older, KeyframeId newer, const SE3& T_older_newer) {
    const uint32_t a = map.keyframes().at(older).world, b = map.keyframes().at(newer).world;
    const SE3 T_a_b =
        claimedPose(map, older, T_older_newer) * map.keyframes().at(newer).T_world_cam.inverse();
    const uint32_t kept = std::min(a, b), gone = std::max(a, b);
    const SE3 T_kept_gone = gone == b ? T_a_b : T_a_b.inverse();
    std::map<KeyframeId, SE3> poses;
    for (const auto& [id, kf] : map.keyframes()) {
        if (kf.world == gone) poses[id] = (T_kept_gone * kf.T_world_cam).normalised();
    }
    moveAll(map, poses);
    for (const auto& [id, pose] : poses) map.setKeyframeWorld(id, kept);
}

/// Features that both views agree on are of one landmark.
uint64_t fuse(SlamMap& map, KeyframeId older, KeyframeId newer, const places::ViewMatch& match,
              LandmarkBuilder& landmarks) {
    uint64_t fused = 0;
    const auto watch = [&](LandmarkId landmark, KeyframeId keyframe, uint32_t feature) {
        if (map.landmarks().at(landmark).observations.count(keyframe) != 0) return;
        map.observe(landmark, keyframe, feature);
        landmarks.known(map.keyframes().at(keyframe), feature, landmark);
        ++fused;
    };
    for (const auto& [fa, fb] : match.features) {
        const auto la = map.keyframes().at(older).landmarks[fa];
        const auto lb = map.keyframes().at(newer).landmarks[fb];
        if (la && lb) {
            if (*la == *lb) continue;
            const LandmarkId kept = std::min(*la, *lb), gone = std::max(*la, *lb);
            landmarks.merged(map, kept, gone);
            map.mergeLandmarks(kept, gone);
            ++fused;
        } else if (la) {
            watch(*la, newer, fb);
        } else if (lb) {
            watch(*lb, older, fa);
        }
    }
    return fused;
}

}  // namespace

bool LoopKeeper::agree(const SlamMap& map, const Claim& a, const Claim& b) const {
    const auto& kfs = map.keyframes();
    if (a.newer == b.newer || kfs.at(a.newer).world != kfs.at(b.newer).world ||
        kfs.at(a.older).world != kfs.at(b.older).world) {
        return false;
    }
    // Both say where b's newer camera is; a's by what the map knows between the newer two.
    const SE3 T_newer_newer = kfs.at(a.newer).T_world_cam.inverse() * kfs.at(b.newer).T_world_cam;
    const SE3 T_world_b = claimedPose(map, b.older, b.match.T_a_b);
    const SE3 byA = claimedPose(map, a.older, a.match.T_a_b) * T_newer_newer;
    const SE3 difference = byA.inverse() * T_world_b;
    return difference.translation().norm() < options_.confirm_m &&
           difference.angle_rad() < options_.confirm_rad;
}

std::vector<LoopKeeper::Claim> LoopKeeper::believed(const SlamMap& map, const LoopUpdate& update) {
    std::vector<Claim> out;
    while (!waiting_.empty() &&
           update.id.value - waiting_.front().newer.value > options_.confirmWithin) {
        waiting_.pop_front();
    }
    for (const auto& m : update.matches) {
        const Claim claim{m.other, update.id, m.match, m.near};
        if (m.near && map.keyframes().at(m.other).world == map.keyframes().at(update.id).world) {
            out.push_back(claim);
            continue;
        }
        std::vector<std::size_t> agreeing;
        for (std::size_t i = 0; i < waiting_.size(); ++i) {
            if (agree(map, waiting_[i], claim)) agreeing.push_back(i);
        }
        if (agreeing.size() + 1 < options_.confirmations) {
            waiting_.push_back(claim);
            continue;
        }
        for (const std::size_t i : agreeing) out.push_back(waiting_[i]);
        for (auto i = agreeing.rbegin(); i != agreeing.rend(); ++i) {
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(*i));
        }
        out.push_back(claim);
    }
    return out;
}

LoopEdge LoopKeeper::edgeOf(const Claim& claim) const {
    Mat6 floor = Mat6::Zero();
    floor.diagonal() << geometry::Vec3::Constant(options_.matchFloor_m * options_.matchFloor_m),
        geometry::Vec3::Constant(options_.matchFloor_rad * options_.matchFloor_rad);
    const Mat6 covariance = claim.match.information.inverse() + floor;
    const Mat6 information = covariance.inverse();
    return {claim.older, claim.newer, claim.match.T_a_b,
            0.5 * (information + information.transpose())};
}

map::LoopRecord LoopKeeper::recordOf(const SlamMap& map, const Claim& claim) const {
    map::LoopRecord out;
    const auto& older = map.keyframes().at(claim.older);
    const auto& newer = map.keyframes().at(claim.newer);
    out.older = older.id;
    out.newer = newer.id;
    out.olderFrame = older.frame;
    out.newerFrame = newer.frame;
    out.T_older_newer = claim.match.T_a_b;
    out.features = claim.match.features.size();
    out.near = claim.near;
    const SE3 correction =
        newer.T_world_cam.inverse() * claimedPose(map, claim.older, claim.match.T_a_b);
    out.correction_m = correction.translation().norm();
    out.correction_rad = correction.angle_rad();
    return out;
}

void LoopKeeper::bend(SlamMap& map, const std::vector<LoopEdge>& edges, KeyframeId firstFree,
                      BackendStatistics& statistics) {
    const auto update = solve(poseGraphProblem(map, edges, firstFree, options_));
    statistics.stages["pose graph"].add(update.time_ms);
    moveAll(map, {update.poses.begin(), update.poses.end()});
    ++statistics.loopsClosed;
}

LoopKeeper::Outcome LoopKeeper::merge(SlamMap& map, const LoopUpdate& update, KeyframeId firstFree,
                                      LandmarkBuilder& landmarks, BackendStatistics& statistics) {
    Outcome out;
    const auto claims = believed(map, update);
    if (claims.empty()) return out;
    out.accepted = true;
    std::vector<LoopEdge> edges;
    bool bends = false;
    for (auto claim = claims.rbegin(); claim != claims.rend(); ++claim) {
        map::LoopRecord record = recordOf(map, *claim);
        record.joined =
            map.keyframes().at(claim->older).world != map.keyframes().at(claim->newer).world;
        if (record.joined) {
            joinWorlds(map, claim->older, claim->newer, claim->match.T_a_b);
            ++statistics.worldsJoined;
            out.moved = true;
        } else if (record.correction_m > options_.bendAbove_m ||
                   record.correction_rad > options_.bendAbove_rad) {
            bends = true;
        }
        edges.push_back(edgeOf(*claim));
        records_.push_back(record);
    }
    if (bends) {
        bend(map, edges, firstFree, statistics);
        out.moved = true;
    }
    for (const auto& claim : claims) {
        statistics.landmarksFused += fuse(map, claim.older, claim.newer, claim.match, landmarks);
    }
    statistics.viewMatches += claims.size();
    return out;
}

}  // namespace djpete::backend
