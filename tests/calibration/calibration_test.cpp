#include <gmock/gmock.h>

#include "djpete/calibration/calibration_check.h"
#include "djpete/calibration/corrected_calibration.h"
#include "made_up_rig.h"

namespace djpete::calibration {
namespace {

using djpete_test::MadeUpStreet;
using djpete_test::TrueRig;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

constexpr double kDeg = 0.017453292519943295;

CalibrationReport checked(const TrueRig& rig, bool scans = true,
                          const CorrectedCalibration* correction = nullptr) {
    const MadeUpStreet street;
    CalibrationCheck check;
    for (unsigned k = 0; k < 8; ++k) {
        auto frame = street.frame(k, rig);
        if (scans) frame.input.scan = &frame.scan;
        if (correction) frame.input.images = correction->apply(frame.input.images);
        check.add(frame.input, frame.odometry);
    }
    return check.report();
}

/// The truth lies within three standard errors, and these are small enough to be of use.
void expectFound(const Estimate& e, double truth, double sigmaAtMost, const char* what) {
    EXPECT_TRUE(e.known) << what;
    EXPECT_LE(std::abs(e.value - truth), 3 * e.sigma)
        << what << " " << e.value << " +- " << e.sigma;
    EXPECT_LT(e.sigma, sigmaAtMost) << what;
}

/// What is left after a correction is its own error, measured with an error of its own.
void expectGone(const Estimate& again, double nominal, const Estimate& before, const char* what) {
    EXPECT_LE(std::abs(again.value - nominal), 3 * std::hypot(again.sigma, before.sigma))
        << what << ", corrected: " << again.value << " +- " << again.sigma;
}

TEST(Calibration, aGoodRigIsCalledGood) {
    const auto r = checked({});
    expectFound(r.rows.offset_px, 0, 0.03, "row offset");
    expectFound(r.disparity.offset_px, 0, 0.1, "disparity offset");
    expectFound(r.disparity.scale, 1, 4e-3, "scale");
    expectFound(r.lidar.tiltX_rad, 0, 0.1 * kDeg, "pitch");
    EXPECT_EQ(r.rows.verdict, "rows are aligned");
    EXPECT_EQ(r.disparity.verdict, "disparities agree with the scans");
    EXPECT_EQ(r.lidar.verdict, "camera and scanner fit");
    EXPECT_GT(r.rows.measurements, 1000U);
    EXPECT_EQ(r.rows.frames, 8U);
}

TEST(Calibration, rowsThatAreOffAreMeasuredAndPutRight) {
    TrueRig rig;
    rig.rowOffset_px = 0.8;
    rig.rowPerColumn_px = 0.5;  // a roll of 0.5 / 500 rad
    const auto r = checked(rig, false);
    expectFound(r.rows.offset_px, 0.8, 0.03, "row offset");
    expectFound(r.rows.perColumn_px, 0.5, 0.05, "roll");
    expectFound(r.rows.perRow_px, 0, 0.1, "focal length");
    EXPECT_THAT(r.rows.verdict, testing::HasSubstr("rolled"));
    const MadeUpStreet street;
    const auto correction = corrected({street.camera, street.T_vehicle_cam}, r);
    const auto again = checked(rig, false, &correction);
    expectGone(again.rows.offset_px, 0, r.rows.offset_px, "row offset");
    expectGone(again.rows.perColumn_px, 0, r.rows.perColumn_px, "roll");
}

TEST(Calibration, aWrongBaselineAndAnOffsetAreMeasuredAndPutRight) {
    TrueRig rig;
    rig.baselineFactor = 0.97;
    rig.columnOffset_px = 0.4;
    const auto r = checked(rig);
    expectFound(r.disparity.scale, 0.97, 4e-3, "scale");
    expectFound(r.disparity.offset_px, 0.4, 0.1, "offset");
    EXPECT_THAT(r.disparity.verdict, testing::HasSubstr("too long"));
    const MadeUpStreet street;
    const auto correction = corrected({street.camera, street.T_vehicle_cam}, r);
    EXPECT_NEAR(correction.camera.model.baseline_m, 0.97 * 0.54,
                3 * 0.54 * r.disparity.scale.sigma);
    const auto again = checked(rig, true, &correction);
    expectGone(again.disparity.scale, 1, r.disparity.scale, "scale");
    expectGone(again.disparity.offset_px, 0, r.disparity.offset_px, "offset");
}

TEST(Calibration, aTiltedCameraIsMeasuredAndPutRight) {
    TrueRig rig;
    Vec6 xi;
    xi << 0.05, -0.04, 0.06, 0.8 * kDeg, -0.5 * kDeg, 0.3 * kDeg;
    rig.T_stated_true = SE3::exp(xi);
    const auto r = checked(rig);
    expectFound(r.lidar.shiftX_m, 0.05, 0.05, "shift x");
    expectFound(r.lidar.shiftY_m, -0.04, 0.05, "shift y");
    expectFound(r.lidar.shiftZ_m, 0.06, 0.05, "shift z");
    expectFound(r.lidar.tiltX_rad, 0.8 * kDeg, 0.1 * kDeg, "pitch");
    expectFound(r.lidar.tiltY_rad, -0.5 * kDeg, 0.1 * kDeg, "yaw");
    expectFound(r.lidar.tiltZ_rad, 0.3 * kDeg, 0.1 * kDeg, "roll");
    expectFound(r.disparity.scale, 1, 4e-3, "scale");
    const MadeUpStreet street;
    const auto correction = corrected({street.camera, street.T_vehicle_cam}, r);
    const SE3 error =
        (street.T_vehicle_cam * rig.T_stated_true).inverse() * correction.camera.T_vehicle_cam;
    EXPECT_LT(error.angle_rad(), 0.2 * kDeg);
    EXPECT_LT(error.translation().norm(), 0.05);
}

TEST(Calibration, withoutScansOrKeyframesItSaysSo) {
    const auto r = checked({}, false);
    EXPECT_TRUE(r.rows.offset_px.known);
    EXPECT_FALSE(r.disparity.scale.known);
    EXPECT_THAT(r.disparity.verdict, testing::HasSubstr("not enough"));
    const CalibrationCheck empty;
    EXPECT_FALSE(empty.report().rows.offset_px.known);
    const auto same = corrected({MadeUpStreet().camera, SE3()}, empty.report());
    EXPECT_FALSE(same.warpsRight());
    EXPECT_EQ(same.camera.model.baseline_m, 0.54);
    EXPECT_THAT(toText(empty.report()), testing::HasSubstr("unknown"));
}

}  // namespace
}  // namespace djpete::calibration
