#include "djpete/evaluation/object_errors.h"

#include "djpete/geometry/mrpt_bridge.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;
using djpete::obs::ObjectClass;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

namespace {

/// A camera that drives 1 m a frame along world x for frames 10..19; labels and objects are added
/// by their place in the world.
class ObjectErrorsTest : public ::testing::Test {
  protected:
    ObjectErrorsTest() {
        cameras.firstFrame = 10;
        for (int i = 0; i < 10; ++i) {
            cameras.T_world_cam.push_back(SE3(Mat3::Identity(), Vec3(i, 0, 0)) *
                                          djpete::geometry::opticalToVehicleAxes());
        }
    }
    void label(int track, std::size_t frame, const SE3& T_world_obj,
               ObjectClass c = ObjectClass::Car) {
        labels.push_back(
            {frame, track, c, Vec3(4, 1.8, 1.5), cameras.at(frame).inverse() * T_world_obj});
    }
    void object(int id, std::size_t frame, const SE3& T_world_obj,
                ObjectClass c = ObjectClass::Car) {
        ObjectRow row;
        row.objectId = id;
        row.frame = frame;
        row.time_s = 0.1 * static_cast<double>(frame);
        row.objectClass = c;
        row.size_m = {4, 1.8, 1.5};
        row.T_world_obj = T_world_obj;
        objects.push_back(row);
    }
    void labelAlways(int track, const SE3& T, ObjectClass c = ObjectClass::Car) {
        for (std::size_t f = 10; f < 20; ++f) label(track, f, T, c);
    }
    void objectAlways(int id, const SE3& T, ObjectClass c = ObjectClass::Car) {
        for (std::size_t f = 10; f < 20; ++f) object(id, f, T, c);
    }
    ObjectErrors evaluate() const {
        return evaluateObjects(objects, labels, cameras, cameras, criteria);
    }

    CameraPath cameras;
    std::vector<LabelBox> labels;
    std::vector<ObjectRow> objects;
    ObjectCriteria criteria;
    const SE3 left_ = SE3::fromYaw(0, {20, 4, 0}), right_ = SE3::fromYaw(0.1, {25, -4, 0});
};

SE3 shifted(const SE3& T, const Vec3& by) { return {T.rotation(), T.translation() + by}; }

}  // namespace

TEST_F(ObjectErrorsTest, PerfectObjectsHaveNoError) {
    labelAlways(1, left_);
    labelAlways(2, right_);
    objectAlways(30, right_);
    objectAlways(40, left_);
    const auto e = evaluate();
    EXPECT_EQ(e.labelled, 2U);
    EXPECT_EQ(e.matchedOneToOne, 2U);
    EXPECT_EQ(e.duplicated + e.missed + e.falseObjectIds.size(), 0U);
    EXPECT_EQ(e.centre_m.count, 20U);
    EXPECT_NEAR(e.centre_m.p90.value(), 0, 1e-12);
    EXPECT_NEAR(e.yaw_deg.p90.value(), 0, 1e-6);
    EXPECT_NEAR(e.length_m.p90.value(), 0, 1e-12);
    ASSERT_EQ(e.tracks.size(), 2U);
    EXPECT_THAT(e.tracks[0].objectIds, ElementsAre(40));
    EXPECT_THAT(e.tracks[1].objectIds, ElementsAre(30));
    EXPECT_FALSE(e.tracks[0].moving);
}

TEST_F(ObjectErrorsTest, KnownOffsetsAreMeasured) {
    labelAlways(1, left_);
    objectAlways(1, SE3::fromYaw(M_PI - 0.1, left_.translation() + Vec3(0.3, 0.4, 1.2)));
    for (auto& row : objects) row.size_m = {4.5, 1.6, 1.6};
    const auto e = evaluate();
    EXPECT_NEAR(e.centre_m.median.value(), 1.3, 1e-9);
    EXPECT_NEAR(e.centre_m.mean.value(), 1.3, 1e-9);
    EXPECT_NEAR(e.bev_m.median.value(), 0.5, 1e-9);
    EXPECT_NEAR(e.yaw_deg.median.value(), 180 - 0.1 * 180 / M_PI, 1e-6);
    EXPECT_NEAR(e.yawModPi_deg.median.value(), 0.1 * 180 / M_PI, 1e-6);
    EXPECT_NEAR(e.length_m.median.value(), 0.5, 1e-9);
    EXPECT_NEAR(e.width_m.median.value(), 0.2, 1e-9);
    EXPECT_NEAR(e.height_m.median.value(), 0.1, 1e-9);
}

TEST_F(ObjectErrorsTest, MedianAndNinetiethPercentileOfLadder) {
    for (std::size_t f = 10; f < 20; ++f) {
        label(1, f, left_);
        object(1, f, shifted(left_, Vec3(0, 0, 0.1 * static_cast<double>(f - 10))));
    }
    const auto e = evaluate();  // errors 0, 0.1 .. 0.9
    EXPECT_NEAR(e.centre_m.median.value(), 0.45, 1e-9);
    EXPECT_NEAR(e.centre_m.p90.value(), 0.81, 1e-9);
}

TEST_F(ObjectErrorsTest, ASecondObjectAtTheSameLabelIsADuplicate) {
    labelAlways(1, left_);
    objectAlways(1, left_);
    object(2, 15, shifted(left_, {1.0, 0, 0}));
    const auto e = evaluate();
    EXPECT_EQ(e.duplicated, 1U);
    EXPECT_EQ(e.matchedOneToOne, 0U);
    EXPECT_THAT(e.falseObjectIds, IsEmpty());
    EXPECT_THAT(e.tracks[0].objectIds, ElementsAre(1, 2));
    EXPECT_EQ(e.centre_m.count, 10U) << "the duplicate's row is not a measurement";
}

TEST_F(ObjectErrorsTest, AnObjectThatBreaksInTwoIsADuplicate) {
    labelAlways(1, left_);
    for (std::size_t f = 10; f < 20; ++f) object(f < 15 ? 1 : 2, f, left_);
    EXPECT_EQ(evaluate().duplicated, 1U);
}

TEST_F(ObjectErrorsTest, NothingNearIsMissedAndFalse) {
    labelAlways(1, left_);
    objectAlways(1, shifted(left_, {2.01, 0, 0}));
    const auto e = evaluate();
    EXPECT_EQ(e.missed, 1U);
    EXPECT_THAT(e.falseObjectIds, ElementsAre(1));
    EXPECT_FALSE(e.centre_m.median.has_value());
}

TEST_F(ObjectErrorsTest, NeighboursAreToldApartByNearestPairsFirst) {
    const SE3 other = shifted(left_, {0, 1.9, 0});
    labelAlways(1, left_);
    labelAlways(2, other);
    objectAlways(1, shifted(left_, {0, 0.8, 0}));
    objectAlways(2, shifted(other, {0, -0.7, 0}));  // 1.2 from track 1
    const auto e = evaluate();
    EXPECT_EQ(e.matchedOneToOne, 2U);
    EXPECT_THAT(e.tracks[0].objectIds, ElementsAre(1));
    EXPECT_THAT(e.tracks[1].objectIds, ElementsAre(2));
}

TEST_F(ObjectErrorsTest, ARowAstrayOnAnotherTracksBoxIsNotMeasured) {
    const SE3 other = shifted(left_, {0, 6, 0});
    labelAlways(1, left_);
    labelAlways(2, other);
    for (std::size_t f = 10; f < 19; ++f) object(1, f, left_);
    object(1, 19, shifted(other, {1, 0, 0}));
    const auto e = evaluate();
    EXPECT_THAT(e.tracks[0].objectIds, ElementsAre(1));
    EXPECT_THAT(e.tracks[1].objectIds, IsEmpty());
    EXPECT_EQ(e.missed, 1U);
    EXPECT_EQ(e.centre_m.count, 9U);
}

TEST_F(ObjectErrorsTest, OneObjectForTwoLabelsLeavesOneMissed) {
    labelAlways(1, left_);
    labelAlways(2, shifted(left_, {0, 1.9, 0}));
    objectAlways(1, left_);
    const auto e = evaluate();
    EXPECT_EQ(e.matchedOneToOne, 1U);
    EXPECT_EQ(e.missed, 1U);
}

TEST_F(ObjectErrorsTest, TracksOfFewFramesDoNotCountButExcuse) {
    for (std::size_t f = 10; f < 14; ++f) label(1, f, left_);
    objectAlways(1, left_);
    const auto e = evaluate();
    EXPECT_EQ(e.labelled, 0U);
    EXPECT_THAT(e.falseObjectIds, IsEmpty());
    EXPECT_EQ(e.centre_m.count, 0U);
    label(1, 14, left_);
    EXPECT_EQ(evaluate().matchedOneToOne, 1U);
}

TEST_F(ObjectErrorsTest, OtherClassesOnlyExcuse) {
    labelAlways(1, left_, ObjectClass::Van);
    objectAlways(1, left_);
    criteria.classes = {ObjectClass::Car};
    auto e = evaluate();
    EXPECT_EQ(e.labelled, 0U);
    EXPECT_THAT(e.falseObjectIds, IsEmpty());
    // A pedestrian beside a car takes no vehicle from it, nor does an estimated pedestrian count.
    labels.clear();
    labelAlways(1, left_, ObjectClass::Pedestrian);
    labelAlways(2, shifted(left_, {0, 1.5, 0}));
    objectAlways(2, left_, ObjectClass::Pedestrian);
    e = evaluate();
    EXPECT_EQ(e.matchedOneToOne, 1U);
    EXPECT_EQ(e.duplicated, 0U);
    EXPECT_THAT(e.tracks[0].objectIds, ElementsAre(1));
}

TEST_F(ObjectErrorsTest, ObjectsThatNoLabelCouldShowAreNotFalse) {
    labelAlways(1, left_);
    objectAlways(1, left_);
    objectAlways(2, SE3::fromYaw(0, {-20, 0, 0}));  // behind
    objectAlways(3, SE3::fromYaw(0, {5, 30, 0}));   // to the side
    EXPECT_THAT(evaluate().falseObjectIds, IsEmpty());
    objectAlways(4, SE3::fromYaw(0, {60, 0, 0}));
    EXPECT_THAT(evaluate().falseObjectIds, ElementsAre(4));
    criteria.maxRange_m = 30;
    EXPECT_THAT(evaluate().falseObjectIds, IsEmpty());
}

TEST_F(ObjectErrorsTest, RangeLimitsTracksAndMeasurements) {
    labelAlways(1, SE3::fromYaw(0, {25, 0, 0}));
    labelAlways(2, SE3::fromYaw(0, {60, 0, 0}));
    objectAlways(1, SE3::fromYaw(0, {25, 0, 0}));
    objectAlways(2, SE3::fromYaw(0, {60, 0, 0}));
    criteria.maxRange_m = 20.5;  // frames 15..19 of track 1
    const auto e = evaluate();
    EXPECT_EQ(e.labelled, 1U);
    EXPECT_EQ(e.tracks[0].labelledFrames, 5U);
    EXPECT_EQ(e.centre_m.count, 5U);
    criteria.maxRange_m = 19.5;  // four frames are too few
    EXPECT_EQ(evaluate().labelled, 0U);
}

TEST_F(ObjectErrorsTest, MovingAndStaticTracksAreSelectedByTheirOwnMotion) {
    labelAlways(1, left_);
    objectAlways(1, left_);
    for (std::size_t f = 10; f < 20; ++f) {
        const SE3 T = SE3::fromYaw(0, {20 + 0.5 * static_cast<double>(f - 10), -4, 0});
        label(2, f, T);
        object(2, f, T);
        objects.back().velocity_world = {5.0, 0.3, 0};  // true is 5 m/s along x
    }
    EXPECT_EQ(evaluate().labelled, 2U);
    criteria.motion = MotionSelection::StaticOnly;
    auto e = evaluate();
    ASSERT_EQ(e.tracks.size(), 1U);
    EXPECT_EQ(e.tracks[0].trackId, 1);
    EXPECT_EQ(e.velocity_mps.count, 0U);
    EXPECT_THAT(e.falseObjectIds, IsEmpty());
    criteria.motion = MotionSelection::MovingOnly;
    e = evaluate();
    ASSERT_EQ(e.tracks.size(), 1U);
    EXPECT_EQ(e.tracks[0].trackId, 2);
    EXPECT_TRUE(e.tracks[0].moving);
    EXPECT_EQ(e.velocity_mps.count, 8U) << "no difference at the track's two ends";
    EXPECT_NEAR(e.velocity_mps.median.value(), 0.3, 1e-6);
}

TEST_F(ObjectErrorsTest, MotionIsJudgedByTheCamerasGivenForIt) {
    labelAlways(1, left_);
    CameraPath drifting = cameras;  // seen with these, the static car seems to move
    for (std::size_t i = 0; i < drifting.T_world_cam.size(); ++i) {
        drifting.T_world_cam[i].translation() += Vec3(0.2 * static_cast<double>(i), 0, 0);
    }
    const auto e = evaluateObjects(objects, labels, drifting, cameras, criteria);
    EXPECT_FALSE(e.tracks.at(0).moving);
    EXPECT_TRUE(evaluateObjects(objects, labels, cameras, drifting, criteria).tracks.at(0).moving);
}

TEST_F(ObjectErrorsTest, RowAndLabelOrderDoNotMatter) {
    labelAlways(1, left_);
    labelAlways(2, shifted(left_, {0, 1.9, 0}));
    objectAlways(1, shifted(left_, {0, 0.95, 0}));  // equally far from both
    objectAlways(2, shifted(left_, {0.5, 0.95, 0}));
    const auto a = evaluate();
    std::reverse(labels.begin(), labels.end());
    std::reverse(objects.begin(), objects.end());
    const auto b = evaluate();
    ASSERT_EQ(a.tracks.size(), b.tracks.size());
    for (std::size_t i = 0; i < a.tracks.size(); ++i) {
        EXPECT_EQ(a.tracks[i].objectIds, b.tracks[i].objectIds);
        EXPECT_EQ(a.tracks[i].centre_m, b.tracks[i].centre_m);
    }
}

TEST_F(ObjectErrorsTest, FramesOutsideTheCamerasAreIgnored) {
    labelAlways(1, left_);
    objectAlways(1, left_);
    labels.push_back({9, 1, ObjectClass::Car, Vec3(4, 2, 2), SE3()});
    labels.push_back({20, 5, ObjectClass::Car, Vec3(4, 2, 2), SE3()});
    EXPECT_EQ(evaluate().labelled, 1U);
    EXPECT_EQ(evaluate().tracks[0].labelledFrames, 10U);
}
