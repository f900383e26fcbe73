#include "djpete/obs/calibration.h"

#include "obs_samples.h"

using djpete::obs::DriveInfo;
using djpete::obs::RigCamera;

namespace {

DriveInfo sampleInfo() {
    DriveInfo info;
    info.name = "kitti odometry 00";
    info.firstFrame = 12345678901ULL;
    info.frameCount = 7;
    info.missing = {12345678903ULL, 12345678905ULL};
    RigCamera gray;
    gray.model = {
        718.8560000001234, 717.1, 607.19281234567, 185.2157, 0.53716571886441788, 1241, 376};
    gray.T_vehicle_cam = obs_samples::somePose();
    info.gray = gray;
    RigCamera color = gray;
    color.model.baseline_m = 0;
    color.T_vehicle_cam = obs_samples::somePose().inverse();
    info.color = color;
    info.T_vehicle_velo = obs_samples::SE3::fromYaw(0.1, {1, 2, 3});
    return info;
}

void expectSame(const RigCamera& a, const RigCamera& b) {
    EXPECT_EQ(a.model.fx, b.model.fx);
    EXPECT_EQ(a.model.fy, b.model.fy);
    EXPECT_EQ(a.model.cx, b.model.cx);
    EXPECT_EQ(a.model.cy, b.model.cy);
    EXPECT_EQ(a.model.baseline_m, b.model.baseline_m);
    EXPECT_EQ(a.model.width_px, b.model.width_px);
    EXPECT_EQ(a.model.height_px, b.model.height_px);
    EXPECT_EQ(a.T_vehicle_cam.matrix(), b.T_vehicle_cam.matrix());
}

}  // namespace

TEST(Calibration, IniTextIsExactToTheLastBit) {
    const DriveInfo a = sampleInfo();
    const DriveInfo b = djpete::obs::driveInfoFromIniText(djpete::obs::toIniText(a), "x");
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.firstFrame, b.firstFrame);
    EXPECT_EQ(a.frameCount, b.frameCount);
    EXPECT_EQ(a.missing, b.missing);
    EXPECT_EQ(a.T_vehicle_velo.matrix(), b.T_vehicle_velo.matrix());
    ASSERT_TRUE(b.gray && b.color);
    expectSame(*a.gray, *b.gray);
    expectSame(*a.color, *b.color);
}

TEST(Calibration, ADriveWithoutCamerasSaysSoWhenAsked) {
    DriveInfo a = sampleInfo();
    a.gray.reset();
    EXPECT_EQ(a.mainCamera("d.rawlog").model.baseline_m, 0);
    a.color.reset();
    const DriveInfo b = djpete::obs::driveInfoFromIniText(djpete::obs::toIniText(a), "x");
    EXPECT_FALSE(b.gray || b.color);
    const std::string what = obs_samples::inputError([&] { b.mainCamera("d.rawlog"); });
    EXPECT_NE(what.find("d.rawlog: no camera calibration"), std::string::npos) << what;
}

TEST(Calibration, BrokenTextIsRefusedWithItsPlace) {
    const std::string good = djpete::obs::toIniText(sampleInfo());
    const auto error = [](const std::string& text) {
        return obs_samples::inputError(
            [&] { djpete::obs::driveInfoFromIniText(text, "d.rawlog"); });
    };
    EXPECT_NE(error("[OTHER]\na = 1\n").find("[DRIVE]"), std::string::npos);
    std::string text = good;
    text.replace(text.rfind("718.85"), 3, "-18");
    EXPECT_NE(error(text).find("[COLOR_ON_VEHICLE]"), std::string::npos);
    text = good;
    const auto at = text.find("matrix = ");
    text.replace(at, 30, "matrix = 1 2 x ");
    EXPECT_NE(error(text).find("12 numbers"), std::string::npos);
}
