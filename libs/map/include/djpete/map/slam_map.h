/// The map: a value with invariants. No thread, no solver, no clock.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "djpete/map/entities.h"

namespace djpete::map {

/// Keyframes, frame poses, landmarks and objects, in ordered containers.
/// Invariants (check() throws std::logic_error if broken): every feature's landmark exists and
/// lists that keyframe and feature back; every frame pose and object state refers to an existing
/// keyframe; every object state has an observation; all poses are finite. What is asked of an id
/// that does not exist throws std::logic_error and changes nothing.
class SlamMap {
  public:
    const std::map<KeyframeId, Keyframe>& keyframes() const { return keyframes_; }
    const std::map<FrameId, FramePose>& frames() const { return frames_; }
    const std::map<LandmarkId, Landmark>& landmarks() const { return landmarks_; }
    const std::map<ObjectId, ObjectTrack>& objects() const { return objects_; }
    MapRevision revision() const { return revision_; }

    /// Adds a keyframe and its frame pose; ids are given in order. `keyframe.id` is set here.
    KeyframeId addKeyframe(Keyframe keyframe, bool tracked);
    /// Adds a frame between keyframes; throws std::logic_error if its reference does not exist.
    void addFrame(const FramePose& pose);
    LandmarkId addLandmark(const geometry::Vec3& p_world, const std::array<uint8_t, 3>& rgb);
    void observe(LandmarkId landmark, KeyframeId keyframe, uint32_t feature);
    void removeObservation(LandmarkId landmark, KeyframeId keyframe);
    void removeLandmark(LandmarkId landmark);
    /// Both are one point: `kept` takes the observations of `gone`, but none from a keyframe that
    /// it has one of already. Throws std::logic_error if they are the same.
    void mergeLandmarks(LandmarkId kept, LandmarkId gone);
    void setKeyframePose(KeyframeId keyframe, const geometry::SE3& T_world_cam);
    /// Says that the keyframe's pose is in `world`.
    void setKeyframeWorld(KeyframeId keyframe, uint32_t world);
    void setLandmarkPosition(LandmarkId landmark, const geometry::Vec3& p_world);
    ObjectId addObject(ObjectTrack track);
    /// Replaces the object of the same id.
    void setObject(ObjectTrack track);
    /// Adds an observation with an estimate at its frame; replaces what was there.
    void addObservation(ObjectId object, ObjectObservation observation, const ObjectState& state);
    /// Replaces motion, size, estimates and views; the observations stay.
    void setObjectEstimate(ObjectId object, bool moving, const geometry::Vec3& size_m,
                           std::map<FrameId, ObjectState> states,
                           std::map<FrameId, geometry::SE3> views = {});
    void removeObject(ObjectId object);

    /// T_world_cam of any known frame.
    std::optional<geometry::SE3> cameraAt(FrameId frame) const;
    /// T_world_obj of a state.
    geometry::SE3 T_world_obj(const ObjectState& state) const;
    /// T_world_obj of `object` at `frame`: the state at that frame; else for a static object its
    /// latest one, for a moving one what lies between its neighbours in time. Nothing for a moving
    /// object before its first state and after its last.
    std::optional<geometry::SE3> objectPoseAt(ObjectId object, FrameId frame) const;
    /// The keyframe with the largest id, if any.
    const Keyframe* lastKeyframe() const;

    void check() const;

  private:
    friend struct MapFileAccess;
    void requireAnchors(const std::map<FrameId, ObjectState>& states) const;
    void touch() { ++revision_.value; }

    std::map<KeyframeId, Keyframe> keyframes_;
    std::map<FrameId, FramePose> frames_;
    std::map<LandmarkId, Landmark> landmarks_;
    std::map<ObjectId, ObjectTrack> objects_;
    MapRevision revision_;
    uint64_t nextKeyframe_ = 0, nextLandmark_ = 0, nextObject_ = 0;
};

/// An immutable copy to hand out.
using MapSnapshot = std::shared_ptr<const SlamMap>;

}  // namespace djpete::map
