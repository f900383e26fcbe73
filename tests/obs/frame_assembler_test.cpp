#include "djpete/obs/frame_assembler.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "obs_samples.h"

using djpete::obs::FrameAssembler;

namespace {

mrpt::obs::CObservationRobotPose::Ptr poseAt(double time_s, double x_m = 0) {
    auto o = obs_samples::truth(0);
    o->timestamp = mrpt::Clock::fromDouble(1.3e9 + time_s);
    o->pose.mean = mrpt::poses::CPose3D(x_m, 0, 0);
    return o;
}

}  // namespace

TEST(FrameAssembler, AFrameEndsWhenTheNextOneBegins) {
    FrameAssembler frames;
    EXPECT_FALSE(frames.flush());
    EXPECT_FALSE(frames.add(obs_samples::truth(0)));
    EXPECT_FALSE(frames.add(obs_samples::detectedObjects(0)));
    const auto first = frames.add(obs_samples::detectedObjects(1));
    ASSERT_TRUE(first);
    EXPECT_EQ(first->id.value, 0U);
    EXPECT_EQ(first->stamp, obs_samples::stampOf(0));
    EXPECT_TRUE(first->T_world_vehicle_truth);
    EXPECT_EQ(first->detections.size(), 1U);

    const auto last = frames.flush();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->id.value, 1U);
    EXPECT_FALSE(last->T_world_vehicle_truth);
    EXPECT_FALSE(frames.flush());
    // It goes on after a flush.
    EXPECT_FALSE(frames.add(obs_samples::truth(2)));
    EXPECT_EQ(frames.flush()->id.value, 2U);
}

TEST(FrameAssembler, NumbersSkipMissingFrames) {
    FrameAssembler frames({0, 10, {10, 12, 13}});
    frames.add(obs_samples::truth(0));
    EXPECT_EQ(frames.add(obs_samples::truth(1))->id.value, 11U);
    EXPECT_EQ(frames.flush()->id.value, 14U);
}

TEST(FrameAssembler, ARecordedKeyframeBringsItsOwnNumber) {
    FrameAssembler frames;
    auto keyframe = djpete::obs::CObservationVisualKeyframe::Create();
    keyframe->timestamp = obs_samples::stampOf(0);
    keyframe->frame = {77};
    frames.add(keyframe);
    EXPECT_EQ(frames.flush()->id.value, 77U);
}

TEST(FrameAssembler, StampsSpreadAroundTheFirst) {
    FrameAssembler frames({0.03, 0, {}});
    EXPECT_FALSE(frames.add(poseAt(0.02)));
    EXPECT_FALSE(frames.add(poseAt(0.00)));
    EXPECT_FALSE(frames.add(poseAt(0.05)));
    EXPECT_TRUE(frames.add(poseAt(0.06)));
}

TEST(FrameAssembler, TheFirstOfTwoIsKept) {
    FrameAssembler frames;
    frames.add(poseAt(0, 1));
    frames.add(poseAt(0, 2));
    EXPECT_EQ(frames.flush()->T_world_vehicle_truth->translation().x(), 1);
}

TEST(FrameAssembler, WhatHasNoPlaceIsPassedOver) {
    FrameAssembler frames;
    auto comment = mrpt::obs::CObservationComment::Create();
    comment->timestamp = obs_samples::stampOf(5);
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = obs_samples::stampOf(6);
    EXPECT_FALSE(frames.add(comment));
    EXPECT_FALSE(frames.flush());
    frames.add(obs_samples::truth(0));
    EXPECT_FALSE(frames.add(odometry));
    EXPECT_FALSE(frames.add(comment));
    EXPECT_FALSE(frames.add(obs_samples::detectedObjects(0)));
    EXPECT_EQ(frames.flush()->detections.size(), 1U);
    EXPECT_FALSE(frames.flush());
}
