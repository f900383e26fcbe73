/// A right camera that is not quite where its calibration says.
#include <gtest/gtest.h>

#include "synthetic_street.h"

using namespace djpete;
using namespace djpete_test;

namespace {

/// Shift of the right image's centre that the calibration does not know.
struct Misalignment {
    double columns_px = 0, rows_px = 0;
};

/// Length of the estimated way over that of the true way, driving 14 frames of 0.7 m ahead.
double scaleOfDrive(const Misalignment& wrong, bool calibrate) {
    const SyntheticStreet street;
    frontend::FrontendOptions options;
    options.stereoCalibrate = calibrate;
    frontend::VisualOdometry odometry(options);
    SyntheticStreet seenFromRight;
    seenFromRight.camera.model.cx += wrong.columns_px;
    seenFromRight.camera.model.cy += wrong.rows_px;
    const SE3 T_left_right(Eigen::Matrix3d::Identity(), Vec3(street.camera.model.baseline_m, 0, 0));
    SE3 T_first, T_last;
    constexpr std::size_t kFrames = 14, kFirst = 4;  // the first frames are for learning
    constexpr double kStep_m = 0.7;
    for (std::size_t i = 0; i < kFrames; ++i) {
        const SE3 T_world_cam(geometry::so3Exp({0, 0.004 * static_cast<double>(i), 0}),
                              Vec3(0, 0, kStep_m * static_cast<double>(i)));
        auto in = street.frame(i, T_world_cam);
        in.images.right = seenFromRight.render(T_world_cam * T_left_right);
        const auto out = odometry.process(in);
        EXPECT_TRUE(out->tracked) << "frame " << i;
        T_last = out->T_odom_cam;
        if (i == kFirst) T_first = T_last;
    }
    return (T_last.translation() - T_first.translation()).norm() /
           (kStep_m * (kFrames - 1 - kFirst));
}

}  // namespace

TEST(Calibration, AWellAlignedPairStaysAsItIs) { EXPECT_NEAR(scaleOfDrive({}, true), 1.0, 0.004); }

TEST(Calibration, AShiftOfTheRightImageIsLearntFromMotion) {
    const double asCalibrated = scaleOfDrive({0.5, 0}, false) - 1;
    const double learnt = scaleOfDrive({0.5, 0}, true) - 1;
    EXPECT_GT(std::abs(asCalibrated), 0.01);  // else there is nothing to learn
    EXPECT_LT(std::abs(learnt), 0.4 * std::abs(asCalibrated));
}

TEST(Calibration, AShiftToTheOtherSideToo) {
    const double asCalibrated = scaleOfDrive({-0.5, 0}, false) - 1;
    const double learnt = scaleOfDrive({-0.5, 0}, true) - 1;
    EXPECT_GT(std::abs(asCalibrated), 0.01);
    EXPECT_LT(std::abs(learnt), 0.4 * std::abs(asCalibrated));
}

TEST(Calibration, RowsThatDoNotMatchAreLearnt) {
    EXPECT_NEAR(scaleOfDrive({0, 1.2}, true), 1.0, 0.008);
}
