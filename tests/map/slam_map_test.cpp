#include "djpete/map/slam_map.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace djpete::map {
namespace {

using geometry::SE3;
using geometry::Vec3;

Keyframe keyframeWith(uint64_t frame, std::size_t features, const SE3& T_world_cam = SE3()) {
    Keyframe kf;
    kf.frame = {frame};
    kf.T_world_cam = T_world_cam;
    kf.features.resize(features);
    return kf;
}

ObjectTrack objectSeenAt(const SlamMap& map, FrameId frame, const SE3& T_anchor_obj) {
    ObjectTrack track;
    ObjectObservation o;
    o.frame = frame;
    track.observations[frame] = o;
    ObjectState s;
    s.frame = frame;
    s.anchor = map.lastKeyframe()->id;
    s.T_anchor_obj = T_anchor_obj;
    track.states[frame] = s;
    return track;
}

TEST(SlamMap, idsRiseAndObservationsKnowEachOther) {
    SlamMap map;
    const auto a = map.addKeyframe(keyframeWith(0, 3), true);
    const auto b = map.addKeyframe(keyframeWith(4, 2), true);
    EXPECT_LT(a, b);
    const auto l = map.addLandmark({1, 2, 3}, {1, 2, 3});
    map.observe(l, a, 2);
    map.observe(l, b, 0);
    map.check();
    EXPECT_EQ(map.keyframes().at(a).landmarks[2], l);
    map.removeObservation(l, a);
    EXPECT_FALSE(map.keyframes().at(a).landmarks[2]);
    map.removeLandmark(l);
    EXPECT_FALSE(map.keyframes().at(b).landmarks[0]);
    map.check();
}

TEST(SlamMap, framesFollowTheirKeyframe) {
    SlamMap map;
    const auto a = map.addKeyframe(keyframeWith(0, 0), true);
    map.addFrame({{1}, {}, a, SE3::fromYaw(0, {1, 0, 0}), true});
    map.setKeyframePose(a, SE3::fromYaw(0, {0, 5, 0}));
    EXPECT_TRUE(map.cameraAt({1})->translation().isApprox(Vec3(1, 5, 0)));
    EXPECT_FALSE(map.cameraAt({2}));
}

TEST(SlamMap, anObjectMovesAlongWithItsAnchor) {
    SlamMap map;
    const auto a = map.addKeyframe(keyframeWith(0, 0), true);
    const auto id = map.addObject(objectSeenAt(map, {0}, SE3::fromYaw(0, {0, 0, 10})));
    map.setKeyframePose(a, SE3::fromYaw(0, {3, 0, 0}));
    EXPECT_TRUE(map.objectPoseAt(id, {0})->translation().isApprox(Vec3(3, 0, 10)));
}

TEST(SlamMap, aStandingObjectIsKnownAtEveryFrameAMovingOneOnlyWhereSeen) {
    SlamMap map;
    map.addKeyframe(keyframeWith(0, 0), true);
    auto track = objectSeenAt(map, {0}, SE3::fromYaw(0, {0, 0, 10}));
    const auto standing = map.addObject(track);
    track.moving = true;
    const auto moving = map.addObject(track);
    EXPECT_TRUE(map.objectPoseAt(standing, {7}));
    EXPECT_TRUE(map.objectPoseAt(moving, {0}));
    EXPECT_FALSE(map.objectPoseAt(moving, {7}));
    EXPECT_FALSE(map.objectPoseAt({99}, {0}));
}

TEST(SlamMap, everyChangeRaisesTheRevision) {
    SlamMap map;
    auto revision = map.revision();
    const auto rises = [&] {
        const bool risen = revision < map.revision();
        revision = map.revision();
        return risen;
    };
    const auto kf = map.addKeyframe(keyframeWith(0, 1), true);
    EXPECT_TRUE(rises());
    const auto l = map.addLandmark({0, 0, 1}, {});
    EXPECT_TRUE(rises());
    map.observe(l, kf, 0);
    EXPECT_TRUE(rises());
    const auto object = map.addObject(objectSeenAt(map, {0}, SE3()));
    EXPECT_TRUE(rises());
    map.setObjectEstimate(object, true, {4, 2, 1}, {});
    EXPECT_TRUE(rises());
    map.removeObject(object);
    EXPECT_TRUE(rises());
}

TEST(SlamMap, whatIsBrokenIsToldAndChangesNothing) {
    SlamMap map;
    const auto a = map.addKeyframe(keyframeWith(0, 2), true);
    const auto l = map.addLandmark({0, 0, 1}, {});
    map.observe(l, a, 0);
    const auto revision = map.revision();
    EXPECT_THROW(map.addKeyframe(keyframeWith(0, 0), true), std::logic_error);
    EXPECT_THROW(map.observe(l, a, 1), std::logic_error);
    EXPECT_THROW(map.observe({9}, a, 1), std::logic_error);
    EXPECT_THROW(map.observe(l, {9}, 0), std::logic_error);
    EXPECT_THROW(map.removeObservation({9}, a), std::logic_error);
    EXPECT_THROW(map.removeLandmark({9}), std::logic_error);
    EXPECT_THROW(map.setKeyframePose({9}, SE3()), std::logic_error);
    EXPECT_THROW(map.setLandmarkPosition({9}, {}), std::logic_error);
    EXPECT_THROW(map.addFrame({{1}, {}, {9}, SE3(), true}), std::logic_error);
    EXPECT_THROW(map.addFrame({{0}, {}, a, SE3(), true}), std::logic_error);
    EXPECT_THROW(map.removeObject({9}), std::logic_error);
    ObjectTrack unanchored = objectSeenAt(map, {0}, SE3());
    unanchored.states.begin()->second.anchor = {9};
    EXPECT_THROW(map.addObject(unanchored), std::logic_error);
    EXPECT_EQ(map.revision(), revision);
    map.check();
}

TEST(SlamMap, mergedLandmarksKeepOneObservationPerKeyframe) {
    SlamMap map;
    const auto a = map.addKeyframe(keyframeWith(0, 2), true);
    const auto b = map.addKeyframe(keyframeWith(1, 2), true);
    const auto c = map.addKeyframe(keyframeWith(2, 1), true);
    const auto kept = map.addLandmark({0, 0, 1}, {}), gone = map.addLandmark({0, 0, 1.1}, {});
    map.observe(kept, a, 0);
    map.observe(kept, b, 0);
    map.observe(gone, b, 1);
    map.observe(gone, c, 0);
    map.mergeLandmarks(kept, gone);
    map.check();
    EXPECT_EQ(map.landmarks().count(gone), 0U);
    EXPECT_EQ(map.landmarks().at(kept).observations,
              (std::map<KeyframeId, uint32_t>{{a, 0}, {b, 0}, {c, 0}}));
    EXPECT_FALSE(map.keyframes().at(b).landmarks[1]);
    EXPECT_THROW(map.mergeLandmarks(kept, kept), std::logic_error);
    EXPECT_THROW(map.mergeLandmarks(kept, gone), std::logic_error);
    map.check();
}

TEST(SlamMap, checkFindsAPoseThatIsNotFinite) {
    SlamMap map;
    const auto a = map.addKeyframe(keyframeWith(0, 0), true);
    map.setKeyframePose(a, SE3::fromYaw(0, {NAN, 0, 0}));
    EXPECT_THROW(map.check(), std::logic_error);
}

}  // namespace
}  // namespace djpete::map
