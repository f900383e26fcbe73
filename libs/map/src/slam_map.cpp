#include "djpete/map/slam_map.h"

#include <chrono>
#include <iterator>
#include <stdexcept>
#include <string>

#include "djpete/map/object_rules.h"

namespace djpete::map {

namespace {

[[noreturn]] void broken(const std::string& what) { throw std::logic_error("SlamMap: " + what); }

template <class Map, class Key>
auto& at(Map& map, const Key& key, const char* what) {
    const auto it = map.find(key);
    if (it == map.end()) broken(std::string("no ") + what + " " + std::to_string(key.value));
    return it->second;
}

}  // namespace

KeyframeId SlamMap::addKeyframe(Keyframe keyframe, bool tracked) {
    if (frames_.count(keyframe.frame) != 0) {
        broken("frame " + std::to_string(keyframe.frame.value) + " twice");
    }
    keyframe.id = KeyframeId{nextKeyframe_++};
    keyframe.landmarks.resize(keyframe.features.size());
    const KeyframeId id = keyframe.id;
    frames_[keyframe.frame] = {keyframe.frame, keyframe.stamp, id, geometry::SE3(), tracked};
    keyframes_.emplace(id, std::move(keyframe));
    touch();
    return id;
}

void SlamMap::addFrame(const FramePose& pose) {
    at(keyframes_, pose.reference, "keyframe");
    if (!frames_.emplace(pose.frame, pose).second) {
        broken("frame " + std::to_string(pose.frame.value) + " twice");
    }
    touch();
}

LandmarkId SlamMap::addLandmark(const geometry::Vec3& p_world, const std::array<uint8_t, 3>& rgb) {
    const LandmarkId id{nextLandmark_++};
    landmarks_.emplace(id, Landmark{id, p_world, rgb, {}});
    touch();
    return id;
}

void SlamMap::observe(LandmarkId landmark, KeyframeId keyframe, uint32_t feature) {
    auto& kf = at(keyframes_, keyframe, "keyframe");
    auto& lm = at(landmarks_, landmark, "landmark");
    if (feature >= kf.features.size()) broken("feature index out of range");
    if (kf.landmarks[feature] || lm.observations.count(keyframe) != 0) broken("observed twice");
    kf.landmarks[feature] = landmark;
    lm.observations[keyframe] = feature;
    touch();
}

void SlamMap::removeObservation(LandmarkId landmark, KeyframeId keyframe) {
    auto& lm = at(landmarks_, landmark, "landmark");
    const auto it = lm.observations.find(keyframe);
    if (it == lm.observations.end()) broken("no such observation");
    at(keyframes_, keyframe, "keyframe").landmarks[it->second].reset();
    lm.observations.erase(it);
    touch();
}

void SlamMap::removeLandmark(LandmarkId landmark) {
    const auto& lm = at(landmarks_, landmark, "landmark");
    for (const auto& [keyframe, feature] : lm.observations) {
        at(keyframes_, keyframe, "keyframe").landmarks[feature].reset();
    }
    landmarks_.erase(landmark);
    touch();
}

void SlamMap::mergeLandmarks(LandmarkId kept, LandmarkId gone) {
    if (kept == gone) broken("a landmark cannot be merged with itself");
    auto& to = at(landmarks_, kept, "landmark");
    for (const auto& [keyframe, feature] : at(landmarks_, gone, "landmark").observations) {
        auto& link = at(keyframes_, keyframe, "keyframe").landmarks[feature];
        link.reset();
        if (to.observations.emplace(keyframe, feature).second) link = kept;
    }
    landmarks_.erase(gone);
    touch();
}

void SlamMap::setKeyframePose(KeyframeId keyframe, const geometry::SE3& T_world_cam) {
    at(keyframes_, keyframe, "keyframe").T_world_cam = T_world_cam;
    touch();
}

void SlamMap::setKeyframeWorld(KeyframeId keyframe, uint32_t world) {
    at(keyframes_, keyframe, "keyframe").world = world;
    touch();
}

void SlamMap::setLandmarkPosition(LandmarkId landmark, const geometry::Vec3& p_world) {
    at(landmarks_, landmark, "landmark").p_world = p_world;
    touch();
}

void SlamMap::requireAnchors(const std::map<FrameId, ObjectState>& states) const {
    for (const auto& [frame, state] : states) at(keyframes_, state.anchor, "keyframe");
}

ObjectId SlamMap::addObject(ObjectTrack track) {
    requireAnchors(track.states);
    track.id = ObjectId{nextObject_++};
    const ObjectId id = track.id;
    objects_.emplace(id, std::move(track));
    touch();
    return id;
}

void SlamMap::setObject(ObjectTrack track) {
    requireAnchors(track.states);
    at(objects_, track.id, "object") = std::move(track);
    touch();
}

void SlamMap::addObservation(ObjectId object, ObjectObservation observation,
                             const ObjectState& state) {
    auto& track = at(objects_, object, "object");
    at(keyframes_, state.anchor, "keyframe");
    if (state.frame != observation.frame) broken("state and observation of two frames");
    track.states[state.frame] = state;
    track.observations[observation.frame] = std::move(observation);
    touch();
}

void SlamMap::setObjectEstimate(ObjectId object, bool moving, const geometry::Vec3& size_m,
                                std::map<FrameId, ObjectState> states,
                                std::map<FrameId, geometry::SE3> views) {
    auto& track = at(objects_, object, "object");
    requireAnchors(states);
    track.moving = moving;
    track.size_m = size_m;
    track.states = std::move(states);
    track.views = std::move(views);
    touch();
}

void SlamMap::removeObject(ObjectId object) {
    at(objects_, object, "object");
    objects_.erase(object);
    touch();
}

std::optional<geometry::SE3> SlamMap::cameraAt(FrameId frame) const {
    const auto it = frames_.find(frame);
    if (it == frames_.end()) return std::nullopt;
    return at(keyframes_, it->second.reference, "keyframe").T_world_cam * it->second.T_ref_cam;
}

geometry::SE3 SlamMap::T_world_obj(const ObjectState& state) const {
    return at(keyframes_, state.anchor, "keyframe").T_world_cam * state.T_anchor_obj;
}

std::optional<geometry::SE3> SlamMap::objectPoseAt(ObjectId object, FrameId frame) const {
    const auto it = objects_.find(object);
    if (it == objects_.end() || it->second.states.empty()) return std::nullopt;
    const auto& states = it->second.states;
    const auto after = states.lower_bound(frame);
    if (after != states.end() && after->first == frame) return T_world_obj(after->second);
    if (!it->second.moving) return T_world_obj(states.rbegin()->second);
    if (after == states.begin() || after == states.end()) return std::nullopt;
    const auto before = std::prev(after);
    const auto a = frames_.find(before->first), b = frames_.find(after->first),
               now = frames_.find(frame);
    if (a == frames_.end() || b == frames_.end() || now == frames_.end()) return std::nullopt;
    const auto seconds = [&](const FramePose& pose) {
        return std::chrono::duration<double>(pose.stamp - a->second.stamp).count();
    };
    return interpolated({T_world_obj(before->second), before->second.twist},
                        T_world_obj(after->second), seconds(b->second), seconds(now->second));
}

const Keyframe* SlamMap::lastKeyframe() const {
    return keyframes_.empty() ? nullptr : &keyframes_.rbegin()->second;
}

void SlamMap::check() const {
    for (const auto& [id, kf] : keyframes_) {
        if (kf.landmarks.size() != kf.features.size()) broken("keyframe with torn features");
        if (!kf.T_world_cam.matrix().allFinite()) broken("keyframe pose not finite");
        for (std::size_t i = 0; i < kf.landmarks.size(); ++i) {
            if (!kf.landmarks[i]) continue;
            const auto& seen = at(landmarks_, *kf.landmarks[i], "landmark").observations;
            const auto it = seen.find(id);
            if (it == seen.end() || it->second != i) broken("landmark does not know its keyframe");
        }
    }
    for (const auto& [id, lm] : landmarks_) {
        if (!lm.p_world.allFinite()) broken("landmark not finite");
        for (const auto& [keyframe, feature] : lm.observations) {
            const auto& kf = at(keyframes_, keyframe, "keyframe");
            if (feature >= kf.landmarks.size() || kf.landmarks[feature] != id) {
                broken("keyframe does not know its landmark");
            }
        }
    }
    for (const auto& [frame, pose] : frames_) at(keyframes_, pose.reference, "keyframe");
    for (const auto& [id, object] : objects_) {
        for (const auto& [frame, state] : object.states) {
            at(keyframes_, state.anchor, "keyframe");
            if (!state.T_anchor_obj.matrix().allFinite()) broken("object pose not finite");
            if (object.observations.count(frame) == 0) broken("object state without observation");
        }
    }
}

}  // namespace djpete::map
