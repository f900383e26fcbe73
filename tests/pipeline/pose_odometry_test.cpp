#include "djpete/pipeline/pose_odometry.h"

#include <gtest/gtest.h>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"

namespace djpete::pipeline {
namespace {

using geometry::SE3;
using geometry::Vec3;

obs::RigCamera rig() {
    obs::RigCamera cam;
    cam.model = {700, 700, 600, 180, 0, 1241, 376};
    cam.T_vehicle_cam = SE3(geometry::opticalToVehicleAxes().rotation(), Vec3(0.3, 0, -0.1));
    return cam;
}

obs::SensorFrame frameAt(uint64_t number, const SE3& T_world_vehicle) {
    obs::SensorFrame frame;
    frame.id = {number};
    frame.stamp = mrpt::Clock::fromDouble(1e9 + 0.1 * double(number));
    frame.T_world_vehicle_truth = T_world_vehicle;
    return frame;
}

TEST(PoseOdometry, StartsAtTheVehicleOfTheFirstFrame) {
    PoseOdometry odometry(rig());
    const SE3 T_world_vehicle = SE3::fromYaw(0.7, {10, 20, 1});
    const auto first = odometry.process(frameAt(3, T_world_vehicle));
    EXPECT_TRUE(first->isKeyframe);
    EXPECT_LT((first->T_odom_cam.matrix() - rig().T_vehicle_cam.matrix()).norm(), 1e-12);
    const SE3 T_step = SE3::fromYaw(0.01, {1, 0, 0});
    const auto second = odometry.process(frameAt(4, T_world_vehicle * T_step));
    EXPECT_LT((second->T_odom_cam.matrix() - (T_step * rig().T_vehicle_cam).matrix()).norm(),
              1e-12);
    EXPECT_EQ(second->frame.value, 4U);
}

TEST(PoseOdometry, MakesKeyframesByDistanceAndTurn) {
    PoseOdometry odometry(rig(), {1.5, 0.1});
    EXPECT_TRUE(odometry.process(frameAt(0, SE3()))->isKeyframe);
    EXPECT_FALSE(odometry.process(frameAt(1, SE3::fromYaw(0, {1, 0, 0})))->isKeyframe);
    EXPECT_TRUE(odometry.process(frameAt(2, SE3::fromYaw(0, {2, 0, 0})))->isKeyframe);
    EXPECT_TRUE(odometry.process(frameAt(3, SE3::fromYaw(0.2, {2, 0, 0})))->isKeyframe);
}

TEST(PoseOdometry, FrameWithoutPoseIsBadInput) {
    PoseOdometry odometry(rig());
    obs::SensorFrame frame;
    frame.id = {12};
    try {
        odometry.process(frame);
        FAIL();
    } catch (const obs::InputError& e) {
        EXPECT_NE(std::string(e.what()).find("frame 12"), std::string::npos);
    }
}

}  // namespace
}  // namespace djpete::pipeline
