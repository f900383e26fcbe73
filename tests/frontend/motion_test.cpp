/// Poses on a synthetic street with exactly known motion.
#include <gtest/gtest.h>

#include <set>

#include "synthetic_street.h"

using namespace djpete;
using namespace djpete_test;
using frontend::VisualOdometry;
using geometry::Vec6;

namespace {

Vec6 twist(double x, double y, double z, double rx, double ry, double rz) {
    Vec6 out;
    out << x, y, z, rx, ry, rz;
    return out;
}

/// T_world_cam of frames 0..n-1 that move by `step` per frame.
std::vector<SE3> steadyMotion(const Vec6& step, std::size_t n) {
    std::vector<SE3> out{SE3()};
    while (out.size() < n) out.push_back(out.back() * SE3::exp(step));
    return out;
}

SE3 inWorld(const SE3& T_odom_cam, const SyntheticStreet& street) {
    return street.camera.T_vehicle_cam.inverse() * T_odom_cam;
}

/// Error of the pose in the last frame: metres and radians.
struct EndError {
    double way_m = 0, turn_rad = 0;
    bool allTracked = true;
};

EndError run(const SyntheticStreet& street, const std::vector<SE3>& T_world_cam, bool stereo,
             bool scans, const frontend::FrontendOptions& options = {}) {
    VisualOdometry odometry(options);
    EndError out;
    SE3 T_last;
    for (std::size_t i = 0; i < T_world_cam.size(); ++i) {
        auto in = street.frame(i, T_world_cam[i], stereo);
        obs::LidarScan scan;
        if (scans) {
            scan = street.scan(T_world_cam[i], static_cast<double>(i));
            in.scan = &scan;
        }
        const auto result = odometry.process(in);
        out.allTracked = out.allTracked && result->tracked;
        T_last = inWorld(result->T_odom_cam, street);
    }
    const SE3 error = T_world_cam.back().inverse() * T_last;
    out.way_m = error.translation().norm();
    out.turn_rad = error.angle_rad();
    return out;
}

}  // namespace

TEST(Motion, OdomIsTheVehicleAtTheFirstFrame) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    const auto first = odometry.process(street.frame(7, SE3()));
    EXPECT_TRUE(first->tracked);
    EXPECT_TRUE(first->isKeyframe);
    EXPECT_EQ(first->frame.value, 7U);
    EXPECT_EQ((first->T_odom_cam.matrix() - street.camera.T_vehicle_cam.matrix()).norm(), 0);
    EXPECT_GT(first->features.size(), 150U);
}

TEST(Motion, DrivingAheadInACurveIsMeasured) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0.8, 0, 0.015, 0), 12);  // 8.8 m, 9.5 degrees
    const auto error = run(street, path, true, false);
    EXPECT_TRUE(error.allTracked);
    EXPECT_LT(error.way_m, 0.01 * 8.8);
    EXPECT_LT(error.turn_rad, 0.15 * M_PI / 180);
}

TEST(Motion, TurningOnTheSpotIsMeasured) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0, 0, 0.04, 0), 8);  // 16 degrees
    const auto error = run(street, path, true, false);
    EXPECT_TRUE(error.allTracked);
    EXPECT_LT(error.way_m, 0.03);
    EXPECT_LT(error.turn_rad, 0.15 * M_PI / 180);
}

TEST(Motion, StandingStillStaysAndNeedsNoKeyframes) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    for (std::size_t i = 0; i < 5; ++i) {
        const auto result = odometry.process(street.frame(i, SE3()));
        EXPECT_LT(inWorld(result->T_odom_cam, street).log().norm(), 1e-3);
        EXPECT_EQ(result->isKeyframe, i == 0);
        EXPECT_EQ(result->features.empty(), i != 0);
    }
}

TEST(Motion, OneCameraWithLidarIsMeasured) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0.6, 0, 0.01, 0), 8);  // 4.2 m
    const auto error = run(street, path, false, true);
    EXPECT_TRUE(error.allTracked);
    EXPECT_LT(error.way_m, 0.02 * 4.2);
    EXPECT_LT(error.turn_rad, 0.2 * M_PI / 180);
}

TEST(Motion, OneCameraSurvivesFramesWithoutScan) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0.6, 0, 0.01, 0), 10);
    VisualOdometry odometry;
    SE3 T_last;
    for (std::size_t i = 0; i < path.size(); ++i) {
        auto in = street.frame(i, path[i], false);
        const obs::LidarScan scan = street.scan(path[i]);
        if (i % 3 == 0) in.scan = &scan;
        const auto result = odometry.process(in);
        EXPECT_TRUE(result->tracked);
        EXPECT_EQ(odometry.last().withLidarDepth > 0, i % 3 == 0);
        T_last = inWorld(result->T_odom_cam, street);
    }
    EXPECT_LT((T_last.translation() - path.back().translation()).norm(), 0.02 * 5.4);
}

TEST(Motion, StereoWithLidarIsMeasured) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0.8, 0, 0.01, 0), 6);  // 4 m
    const auto error = run(street, path, true, true);
    EXPECT_TRUE(error.allTracked);
    EXPECT_LT(error.way_m, 0.01 * 4.0);
}

TEST(Motion, AThingThatMovesAcrossTheViewDoesNotPullThePose) {
    SyntheticStreet street;
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    // 4 m square, 12 to 8 m ahead: a fifth of the image, moving sideways 0.4 m per frame
    street.planes.push_back({z, {-2.5, -0.4, 14}, x, y, 77, 2.0, {0.4, 0, 0}});
    const auto path = steadyMotion(twist(0, 0, 0.5, 0, 0, 0), 9);  // 4 m
    const auto error = run(street, path, true, false);
    EXPECT_TRUE(error.allTracked);
    EXPECT_LT(error.way_m, 0.02 * 4.0);
    EXPECT_LT(error.turn_rad, 0.2 * M_PI / 180);
}

TEST(Motion, MissingFramesAreBridged) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0.5, 0, 0.01, 0), 11);
    VisualOdometry odometry;
    SE3 T_last;
    for (std::size_t i : {0, 1, 2, 3, 6, 7, 10}) {
        const auto result = odometry.process(street.frame(i, path[i]));
        EXPECT_TRUE(result->tracked) << "frame " << i;
        T_last = inWorld(result->T_odom_cam, street);
    }
    EXPECT_LT((T_last.translation() - path.back().translation()).norm(), 0.015 * 5.0);
}

TEST(Motion, ABlackFrameIsPredictedAndTheNextIsMeasuredAgain) {
    const SyntheticStreet street;
    const auto path = steadyMotion(twist(0, 0, 0.5, 0, 0.01, 0), 8);
    VisualOdometry odometry;
    for (std::size_t i = 0; i < path.size(); ++i) {
        auto in = street.frame(i, path[i]);
        if (i == 4) {
            in.images.left = mrpt::img::CImage(640, 240, mrpt::img::CH_GRAY);
            in.images.left.filledRectangle(0, 0, 639, 239, mrpt::img::TColor(0, 0, 0));
            in.images.right = in.images.left.makeDeepCopy();
        }
        const auto result = odometry.process(in);
        EXPECT_EQ(result->tracked, i != 4) << "frame " << i;
        const SE3 T_world_cam = inWorld(result->T_odom_cam, street);
        EXPECT_LT((T_world_cam.translation() - path[i].translation()).norm(), 0.06) << i;
    }
}

TEST(Motion, AJumpLosesTheFrameAndOdometryGoesOnFromThere) {
    const SyntheticStreet street;
    auto path = steadyMotion(twist(0, 0, 0.5, 0, 0, 0), 8);
    const SE3 T_jump(geometry::so3Exp({0, 2.5, 0}), Vec3(0, 0, 10));  // looks back
    for (std::size_t i = 4; i < path.size(); ++i) path[i] = T_jump * path[i];
    VisualOdometry odometry;
    std::set<uint64_t> before, after;
    std::vector<SE3> estimate;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const auto result = odometry.process(street.frame(i, path[i]));
        estimate.push_back(result->T_odom_cam);
        EXPECT_EQ(result->tracked, i != 4) << "frame " << i;
        EXPECT_TRUE(i != 4 || result->isKeyframe);
        for (const auto& f : result->features) (i < 4 ? before : after).insert(f.track.value);
    }
    const SE3 step = estimate[6].inverse() * estimate[7];
    EXPECT_NEAR(step.translation().norm(), 0.5, 0.02);
    ASSERT_FALSE(before.empty());
    ASSERT_FALSE(after.empty());
    EXPECT_LT(*before.rbegin(), *after.begin());  // ids are never used again
}

TEST(Motion, ImagesWithoutTextureAreNotTracked) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    for (std::size_t i = 0; i < 4; ++i) {
        auto in = street.frame(i, SE3());
        in.images.left.filledRectangle(0, 0, 639, 239, mrpt::img::TColor(90, 90, 90));
        in.images.right = in.images.left.makeDeepCopy();
        const auto result = odometry.process(in);
        EXPECT_EQ(result->tracked, i == 0);
        EXPECT_TRUE(result->features.empty());
        EXPECT_TRUE(result->T_odom_cam.translation().allFinite());
    }
}
