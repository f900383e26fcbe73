/// Where a moving object is between the frames that saw it.
#include <gtest/gtest.h>

#include <cmath>

#include "djpete/map/object_rules.h"
#include "djpete/map/slam_map.h"

namespace djpete::map {
namespace {

using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

const SE3 kStart = SE3::fromYaw(0.6, {20, -4, -1});

Vec6 twist(double speed_mps, double turn_radps) {
    Vec6 out = Vec6::Zero();
    out[0] = speed_mps;
    out[5] = turn_radps;
    return out;
}

double distance(const SE3& a, const SE3& b) { return (a.inverse() * b).log().norm(); }

TEST(Interpolated, isExactAtBothEnds) {
    const SE3 end = kStart * SE3::exp(twist(5, 0.4)) * SE3::fromYaw(0.3, {1, 2, 0.5});
    const MovingPose start{kStart, twist(5, 0.4)};
    EXPECT_LT(distance(interpolated(start, end, 2, 0), kStart), 1e-12);
    EXPECT_LT(distance(interpolated(start, end, 2, 2), end), 1e-12);
}

TEST(Interpolated, staysOnTheCircle) {
    const Vec6 w = twist(10, 0.5);  // a circle of 20 m
    const SE3 end = kStart * SE3::exp(3 * w);
    const Vec3 centre = kStart * Vec3(0, 20, 0);
    for (int i = 0; i <= 30; ++i) {
        const SE3 T = interpolated({kStart, w}, end, 3, 0.1 * i);
        EXPECT_LT(distance(T, kStart * SE3::exp(0.1 * i * w)), 1e-9);
        EXPECT_NEAR((T.translation() - centre).norm(), 20, 1e-9);
    }
}

TEST(Interpolated, leavesWithTheTwistAndSpreadsWhatItMisses) {
    // 1 m to the left is missed: at first nothing of it, halfway half.
    const MovingPose start{kStart, twist(10, 0)};
    const SE3 end = kStart * SE3::fromYaw(0, {20, 1, 0});
    const auto left = [&](double t_s) {
        return (kStart.inverse() * interpolated(start, end, 2, t_s)).translation().y();
    };
    EXPECT_NEAR(left(1), 0.5, 1e-12);
    EXPECT_LT(left(0.02), 1e-3);
    EXPECT_GT(left(1.98), 1 - 1e-3);
    for (int i = 0; i < 20; ++i) EXPECT_LT(left(0.1 * i), left(0.1 * (i + 1)));
    const SE3 soon = interpolated(start, end, 2, 1e-4);
    EXPECT_LT(((kStart.inverse() * soon).log() / 1e-4 - start.twist).norm(), 1e-3);
}

/// A map of 10 frames, the even ones keyframes; the camera goes forward and turns. Stamps of a
/// steady 10 Hz, but frame 5 comes late.
struct Drive {
    SlamMap map;
    static double time_s(uint64_t frame) {
        return 0.1 * static_cast<double>(frame) + (frame == 5 ? 0.04 : 0);
    }
    static SE3 camera(uint64_t frame) {
        return SE3::fromYaw(0.05 * static_cast<double>(frame), {static_cast<double>(frame), 0, 0});
    }
    Drive() {
        for (uint64_t f = 0; f < 10; ++f) {
            const auto stamp = mrpt::Clock::fromDouble(1.3e9 + time_s(f));
            if (f % 2 == 0) {
                Keyframe kf;
                kf.frame = {f};
                kf.stamp = stamp;
                kf.T_world_cam = kf.T_odom_cam = camera(f);
                map.addKeyframe(kf, true);
            } else {
                map.addFrame({{f},
                              stamp,
                              map.lastKeyframe()->id,
                              camera(f - 1).inverse() * camera(f),
                              true});
            }
        }
    }
    /// Seen in `frames`, at T_world_obj(time).
    ObjectId add(bool moving, const std::vector<uint64_t>& frames, const Vec6& w) {
        ObjectTrack track;
        track.moving = moving;
        for (const uint64_t f : frames) {
            ObjectState state;
            state.frame = {f};
            state.anchor = map.frames().at({f}).reference;
            state.twist = w;
            state.T_anchor_obj =
                map.keyframes().at(state.anchor).T_world_cam.inverse() * truth(f, w);
            track.states[{f}] = state;
            track.observations[{f}].frame = {f};
        }
        return map.addObject(track);
    }
    static SE3 truth(uint64_t frame, const Vec6& w) { return kStart * SE3::exp(time_s(frame) * w); }
};

TEST(ObjectPoseAt, aMovingObjectGoesOnInItsGaps) {
    Drive d;
    const Vec6 w = twist(10, 0.5);
    const auto id = d.add(true, {1, 2, 7, 8}, w);
    for (uint64_t f = 1; f <= 8; ++f) {
        const auto T = d.map.objectPoseAt(id, {f});
        ASSERT_TRUE(T) << "frame " << f;
        EXPECT_LT(distance(*T, Drive::truth(f, w)), 1e-6) << "frame " << f;
    }
    EXPECT_FALSE(d.map.objectPoseAt(id, {0}));
    EXPECT_FALSE(d.map.objectPoseAt(id, {9}));
    EXPECT_FALSE(d.map.objectPoseAt(id, {99}));
    EXPECT_FALSE(d.map.objectPoseAt({99}, {3}));
}

TEST(ObjectPoseAt, theEndsOfAGapMoveAlongWithTheirKeyframes) {
    Drive d;
    const Vec6 w = twist(10, 0);
    const auto id = d.add(true, {1, 7}, w);
    const SE3 correction = SE3::fromYaw(0.1, {2, 1, 0});
    const auto before = d.map.keyframes();
    for (const auto& [kf, keyframe] : before) {
        d.map.setKeyframePose(kf, correction * keyframe.T_world_cam);
    }
    for (uint64_t f = 1; f <= 7; ++f) {
        EXPECT_LT(distance(*d.map.objectPoseAt(id, {f}), correction * Drive::truth(f, w)), 1e-6);
    }
}

TEST(ObjectPoseAt, aStandingObjectIsWhereItIsInEveryFrame) {
    Drive d;
    const auto id = d.add(false, {3, 4, 8}, Vec6::Zero());
    for (uint64_t f = 0; f <= 9; ++f) {
        EXPECT_LT(distance(*d.map.objectPoseAt(id, {f}), kStart), 1e-12) << "frame " << f;
    }
}

TEST(ObjectPoseAt, anObjectWithoutStatesIsNowhere) {
    Drive d;
    const auto id = d.map.addObject(ObjectTrack{});
    EXPECT_FALSE(d.map.objectPoseAt(id, {3}));
}

TEST(ObjectScore, isTheMeanOfItsDetections) {
    ObjectTrack track;
    EXPECT_EQ(objectScore(track), 0);
    for (const float score : {1.F, 2.F, 6.F}) {
        ObjectObservation o;
        o.frame = {track.observations.size()};
        o.score = score;
        track.observations[o.frame] = o;
    }
    EXPECT_NEAR(objectScore(track), 3, 1e-12);
}

TEST(ObjectViews, turnWithTheObjectAndGoWhenItIsMerged) {
    ObjectTrack track;
    track.views[{4}] = kStart;
    const auto turned = turnedRound(track);
    EXPECT_LT(distance(turned.views.at({4}), kStart * SE3::fromYaw(M_PI, {0, 0, 0})), 1e-12);
    EXPECT_TRUE(merged(track, ObjectTrack{}).views.empty());
    // A new estimate comes with its own views.
    Drive d;
    const auto id = d.add(false, {3}, Vec6::Zero());
    const auto states = d.map.objects().at(id).states;
    d.map.setObjectEstimate(id, false, {4, 2, 1}, states, track.views);
    EXPECT_EQ(d.map.objects().at(id).views.size(), 1U);
    d.map.setObjectEstimate(id, false, {4, 2, 1}, states);
    EXPECT_TRUE(d.map.objects().at(id).views.empty());
}

}  // namespace
}  // namespace djpete::map
