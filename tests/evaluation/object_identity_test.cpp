/// Does an object of the map stay the same, and is it known again?
#include "djpete/evaluation/object_errors.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

/// A camera that stands for 300 frames; cars at places that are far from each other.
class ObjectIdentityTest : public ::testing::Test {
  protected:
    ObjectIdentityTest() {
        cameras.T_world_cam.assign(300, djpete::geometry::opticalToVehicleAxes());
    }
    static SE3 place(int track) { return SE3::fromYaw(0, {20, 10.0 * track, 0}); }
    /// Labels `track` in frames begin .. end-1.
    void label(int track, std::size_t begin, std::size_t end, double speed = 0) {
        for (std::size_t f = begin; f < end; ++f) {
            labels.push_back({f, track, djpete::obs::ObjectClass::Car, Vec3(4, 1.8, 1.5),
                              cameras.at(f).inverse() * moved(track, f, speed)});
        }
    }
    /// Object `id` where `track` is in frames begin .. end-1.
    void object(int id, int track, std::size_t begin, std::size_t end, double speed = 0) {
        for (std::size_t f = begin; f < end; ++f) {
            ObjectRow row;
            row.objectId = id;
            row.frame = f;
            row.size_m = {4, 1.8, 1.5};
            row.T_world_obj = moved(track, f, speed);
            objects.push_back(row);
        }
    }
    static SE3 moved(int track, std::size_t frame, double speed) {
        const SE3 start = place(track);
        return {start.rotation(),
                start.translation() + Vec3(speed * static_cast<double>(frame), 0, 0)};
    }
    ObjectErrors evaluate() const {
        return evaluateObjects(objects, labels, cameras, cameras, criteria);
    }

    CameraPath cameras;
    std::vector<LabelBox> labels;
    std::vector<ObjectRow> objects;
    ObjectCriteria criteria;
};

}  // namespace

TEST_F(ObjectIdentityTest, CountsChangesOfTheObjectOfATrack) {
    label(1, 0, 30);
    object(5, 1, 0, 10);
    object(6, 1, 15, 20);  // a switch, across a gap of rows too
    object(5, 1, 20, 30);  // and back
    label(2, 0, 30);
    object(7, 2, 0, 10);
    object(7, 2, 20, 30);
    label(3, 0, 30);  // missed: neither with nor without a switch
    const auto e = evaluate();
    ASSERT_EQ(e.tracks.size(), 3U);
    EXPECT_EQ(e.tracks[0].switches, 2U);
    EXPECT_EQ(e.tracks[1].switches, 0U);
    EXPECT_EQ(e.switches, 2U);
    EXPECT_EQ(e.withoutSwitch, 1U);
    EXPECT_EQ(e.seenAgain, 0U);
}

TEST_F(ObjectIdentityTest, ObjectsThatSwapTheirTracksSwitchBoth) {
    // Object 5 is on track 1 for 20 frames, then on track 2 for 10; object 6 the other way round.
    // By votes each belongs to one track; the swap is seen all the same.
    label(1, 0, 30);
    label(2, 0, 30);
    object(5, 1, 0, 20);
    object(6, 2, 0, 20);
    object(6, 1, 20, 30);
    object(5, 2, 20, 30);
    const auto e = evaluate();
    EXPECT_EQ(e.matchedOneToOne, 2U);
    EXPECT_EQ(e.switches, 2U);
    EXPECT_EQ(e.withoutSwitch, 0U);
}

TEST_F(ObjectIdentityTest, KnownAgainAfterAGap) {
    // Visits 0..9, 60..69 and 200..209. The first gap has 50 frames, the second 130.
    for (const std::size_t begin : {0U, 60U, 200U}) label(1, begin, begin + 10);
    object(5, 1, 0, 10);
    object(5, 1, 60, 70);
    object(6, 1, 203, 210);
    const auto e = evaluate();
    EXPECT_EQ(e.seenAgain, 2U);
    EXPECT_EQ(e.knownAgain, 1U);
    EXPECT_EQ(e.tracks.at(0).seenAgain, 2U);
    EXPECT_EQ(e.tracks.at(0).knownAgain, 1U);
    EXPECT_EQ(e.switches, 1U);
    criteria.minGapFrames = 51;
    EXPECT_EQ(evaluate().seenAgain, 1U);
    EXPECT_EQ(evaluate().knownAgain, 0U);
}

TEST_F(ObjectIdentityTest, WhatWasNotMatchedOnBothVisitsIsNotSeenAgain) {
    for (const std::size_t begin : {0U, 100U, 200U}) label(1, begin, begin + 10);
    object(5, 1, 0, 10);
    object(5, 1, 200, 210);
    EXPECT_EQ(evaluate().seenAgain, 0U) << "the visit between found nothing";
    object(5, 1, 105, 106);
    EXPECT_EQ(evaluate().seenAgain, 2U);
    EXPECT_EQ(evaluate().knownAgain, 2U);
}

TEST_F(ObjectIdentityTest, BoxesOutOfRangeMakeAGapToo) {
    // The camera is 60 m away in frames 10..99.
    for (std::size_t f = 10; f < 100; ++f) cameras.T_world_cam[f].translation().x() -= 60;
    label(1, 0, 110);
    object(5, 1, 0, 110);
    EXPECT_EQ(evaluate().seenAgain, 0U);
    criteria.maxRange_m = 40;
    EXPECT_EQ(evaluate().seenAgain, 1U);
    EXPECT_EQ(evaluate().knownAgain, 1U);
}

TEST_F(ObjectIdentityTest, MovingTracksAreNotSeenAgain) {
    label(1, 0, 10, 0.2);
    label(1, 100, 110, 0.2);
    object(5, 1, 0, 10, 0.2);
    object(5, 1, 100, 110, 0.2);
    const auto e = evaluate();
    EXPECT_TRUE(e.tracks.at(0).moving);
    EXPECT_EQ(e.seenAgain, 0U);
    EXPECT_EQ(e.withoutSwitch, 1U);
}
