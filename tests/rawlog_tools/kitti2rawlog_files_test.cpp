/// The readers of KITTI's text files, on small made-up ones.
#include <gmock/gmock.h>

#include <cmath>

#include "djpete/geometry/cuboid.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "kitti_calibration.h"
#include "kitti_labels.h"
#include "kitti_poses.h"
#include "made_up_drive.h"

using namespace djpete::kitti2rawlog;
using djpete::geometry::Mat3;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using djpete::obs::ObjectClass;
using testing::HasSubstr;

TEST(KittiBox, AtZeroTheFrontLooksAlongTheCamerasX) {
    const SE3 T_cam_obj = boxPose(Vec3(1, 2, 10), 1.5, 0);
    EXPECT_TRUE(T_cam_obj.translation().isApprox(Vec3(1, 2 - 0.75, 10)));
    EXPECT_TRUE((T_cam_obj.rotation() * Vec3::UnitX()).isApprox(Vec3(1, 0, 0)));
    EXPECT_TRUE((T_cam_obj.rotation() * Vec3::UnitZ()).isApprox(Vec3(0, -1, 0))) << "up";
    EXPECT_NEAR(T_cam_obj.rotation().determinant(), 1, 1e-15);
}

TEST(KittiBox, MinusAQuarterTurnLooksAwayFromTheCamera) {
    const SE3 T_cam_obj = boxPose(Vec3::Zero(), 1, -M_PI / 2);
    EXPECT_TRUE((T_cam_obj.rotation() * Vec3::UnitX()).isApprox(Vec3(0, 0, 1)));
}

TEST(KittiBox, CornersAreThoseOfKittisDevkit) {
    // The devkit: x = +-l/2, y = 0 or -h, z = +-w/2, turned about y by ry, moved to (x, y, z).
    const double l = 4, w = 2, h = 1.5, ry = 0.7;
    const Vec3 bottom(3, 1.6, 20);
    Mat3 R;
    R << std::cos(ry), 0, std::sin(ry), 0, 1, 0, -std::sin(ry), 0, std::cos(ry);
    const SE3 T_cam_obj = boxPose(bottom, h, ry);
    for (const Vec3& c : djpete::geometry::Cuboid{Vec3(l, w, h)}.corners()) {
        double nearest = 1e9;
        for (double x : {-l / 2, l / 2})
            for (double y : {0.0, -h})
                for (double z : {-w / 2, w / 2})
                    nearest =
                        std::min(nearest, (R * Vec3(x, y, z) + bottom - T_cam_obj * c).norm());
        EXPECT_LT(nearest, 1e-12);
    }
}

TEST(KittiLabels, AllColumnLayoutsGiveTheSameBox) {
    const auto dir = djpete_test::scratch("kitti_labels");
    const std::string box = "0 0 -1.8 10 20 110 80 1.5 1.6 4.2 2 1.7 15 0.3";
    const std::map<std::string, std::string> texts{
        {"17.txt", "5 9 Car " + box + "\n"},
        {"18.txt", "5 9 Car " + box + " 0.9\n\n"},
        {"000005.txt", "Car " + box + "\r\n"},
        {"00005.txt", "Car " + box + " 0.9\n"},
        {"comma.txt", "5,2,10,20,110,80,0.9,1.5,1.6,4.2,2,1.7,15,0.3,-1.8\n"},
        {"word.txt", "5, Car, 10,20,110,80,0.9,1.5,1.6,4.2,2,1.7,15,0.3,-1.8\n"}};
    for (const auto& [name, text] : texts) {
        made_up::writeText(dir / name, text);
        const auto all = readDetectionFile(dir / name, {0.2, 4}, "test");
        ASSERT_EQ(all.size(), 1U) << name;
        ASSERT_EQ(all.count(5), 1U) << name;
        ASSERT_EQ(all.at(5).size(), 1U) << name;
        const auto& d = all.at(5)[0];
        EXPECT_EQ(d.objectClass, ObjectClass::Car) << name;
        EXPECT_EQ(d.size_m, Vec3(4.2, 1.6, 1.5)) << name;
        EXPECT_EQ(d.T_sensor_obj.matrix(), boxPose(Vec3(2, 1.7, 15), 1.5, 0.3).matrix()) << name;
        ASSERT_TRUE(d.box) << name;
        EXPECT_EQ(d.box->left, 10) << name;
        EXPECT_EQ(d.box->bottom, 80) << name;
        EXPECT_EQ(d.source, "test");
        EXPECT_FLOAT_EQ(d.score, name == "17.txt" || name == "000005.txt" ? 1.F : 0.9F) << name;
        EXPECT_EQ(d.sourceTrackId.has_value(), name == "17.txt" || name == "18.txt") << name;
        EXPECT_NEAR(d.information(0, 0), 25, 1e-12);
        EXPECT_NEAR(d.information(5, 5), std::pow(180 / (4 * M_PI), 2), 1e-9);
    }
}

TEST(KittiLabels, DontCareIsLeftOut) {
    const auto dir = djpete_test::scratch("kitti_dontcare");
    made_up::writeText(dir / "a.txt",
                       "0 -1 DontCare -1 -1 -10 1 2 3 4 -1000 -1000 -1000 -10 -1 -1 -1\n");
    EXPECT_TRUE(readDetectionFile(dir / "a.txt", {}, "x").empty());
}

TEST(KittiLabels, BrokenRowsAreNamedByLine) {
    const auto dir = djpete_test::scratch("kitti_bad_labels");
    const std::string good = "0 1 Car 0 0 -1.8 10 20 110 80 1.5 1.6 4.2 2 1.7 15 0.3\n";
    const auto error = [&](const std::string& text) -> std::string {
        made_up::writeText(dir / "bad.txt", text);
        try {
            readDetectionFile(dir / "bad.txt", {}, "x");
        } catch (const djpete::obs::InputError& e) {
            return e.what();
        }
        return "accepted";
    };
    EXPECT_THAT(error(good + "0 1 Car 0 0\n"),
                AllOf(HasSubstr("bad.txt:2"), HasSubstr("5 columns")));
    EXPECT_THAT(error("0 1 Car 0 0 -1.8 10 20 110 80 1.5 1.6 4.2 nan 1.7 15 0.3\n"),
                AllOf(HasSubstr("bad.txt:1"), HasSubstr("'nan'")));
    EXPECT_THAT(error("0 1 Car 0 0 -1.8 10 20 110 80 0 1.6 4.2 2 1.7 15 0.3\n"),
                HasSubstr("not positive"));
    EXPECT_THAT(error("-3 1 Car 0 0 -1.8 10 20 110 80 1.5 1.6 4.2 2 1.7 15 0.3\n"),
                HasSubstr("negative"));
    EXPECT_THAT(error("0.5 1 Car 0 0 -1.8 10 20 110 80 1.5 1.6 4.2 2 1.7 15 0.3\n"),
                HasSubstr("whole number"));
    EXPECT_THAT(error("1,2,3,4,5\n"), HasSubstr("comma-separated"));
    EXPECT_THAT(error("0,7,10,20,110,80,0.9,1.5,1.6,4.2,2,1.7,15,0.3,-1.8\n"),
                HasSubstr("type '7'"));
    EXPECT_THAT(error("Car 0 0 -1.8 10 20 110 80 1.5 1.6 4.2 2 1.7 15 0.3\n"),
                HasSubstr("no frame column"));
    EXPECT_EQ(error(good), "accepted");
}

TEST(KittiCalibration, CamerasFollowTheirProjections) {
    const auto dir = djpete_test::scratch("kitti_calib");
    made_up::writeText(dir / "calib.txt", made_up::kCalib);
    const auto c = readCalibrationFile(dir / "calib.txt");
    const auto gray = c.rigCamera(0, 1, {32, 16});
    EXPECT_EQ(gray.model.baseline_m, 0.5);
    EXPECT_TRUE(gray.T_vehicle_cam.translation().isApprox(Vec3(0.3, 0, 0)));
    // The camera's z is the vehicle's x, its x the vehicle's -y.
    EXPECT_TRUE((gray.T_vehicle_cam * Vec3(1, 0, 5)).isApprox(Vec3(5.3, -1, 0)));
    const auto color = c.rigCamera(2, 3, {32, 16});
    EXPECT_EQ(color.model.baseline_m, 0.5);
    EXPECT_TRUE(color.T_vehicle_cam.translation().isApprox(Vec3(0.3, 0.05, 0)));
    EXPECT_EQ(c.rigCamera(2, std::nullopt, {32, 16}).model.baseline_m, 0);
}

TEST(KittiCalibration, WithoutVelodyneTheVehicleSitsInCamera0) {
    const auto dir = djpete_test::scratch("kitti_calib_no_tr");
    const std::string all = made_up::kCalib;
    made_up::writeText(dir / "calib.txt", all.substr(0, all.find("Tr")));
    const auto c = readCalibrationFile(dir / "calib.txt");
    EXPECT_EQ(c.T_vehicle_cam0().matrix(), djpete::geometry::opticalToVehicleAxes().matrix());
}

TEST(KittiTimes, SecondsAndDates) {
    const auto dir = djpete_test::scratch("kitti_times");
    made_up::writeText(dir / "s.txt", "0\n1.037359e-01\n");
    const auto s = readTimes(dir / "s.txt", 1);
    EXPECT_NEAR(mrpt::Clock::toDouble(s[0]), 1316995200.0, 1e-6) << "2011-09-26 00:00:00 UTC";
    EXPECT_EQ((s[1] - s[0]).count(), 1037359) << "ticks of 100 ns";
    made_up::writeText(dir / "d.txt", "2011-09-26 13:04:32.351950336\n2011-10-03 00:00:00.0\n");
    const auto d = readTimes(dir / "d.txt", 1);
    EXPECT_EQ((d[0] - s[0]).count(), (13 * 3600 + 4 * 60 + 32) * 10000000LL + 3519503);
    EXPECT_EQ((d[1] - s[0]).count(), 7 * 86400 * 10000000LL);
    const auto nominal = readTimes(std::nullopt, 10);
    EXPECT_EQ((nominal[10] - nominal[0]).count(), 10000000LL);
}
