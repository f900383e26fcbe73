#include "djpete/observers/point_gatherer.h"

#include <gtest/gtest.h>

#include "djpete/geometry/mrpt_bridge.h"
#include "synthetic_scan.h"

namespace djpete::observers {
namespace {

using geometry::SE3;
using geometry::Vec3;

const Vec3 kSize(4.2, 1.75, 1.5);
const SE3 kCar = SE3::fromYaw(0.3, {12, -4, 0.75 - 1.73});  // in velo

obs::LidarScan street() {
    djpete_test::SyntheticStreet s;
    s.addCar(12, -4, 0.3);
    auto scan = s.scan();
    scan.T_vehicle_velo = SE3::fromYaw(0.1, {0.3, 0, 1.7});
    return scan;
}

TEST(PointGatherer, separatesTheCarFromItsGround) {
    const auto scan = street();
    // A detection that is off by a little of everything.
    const SE3 T_velo_detected = kCar * SE3::fromYaw(0.1, {0.3, -0.2, 0.3});
    const auto points = PointGatherer(scan).gather(T_velo_detected, kSize, {});
    ASSERT_TRUE(points);
    EXPECT_GT(points->body.size(), 100U);
    EXPECT_LE(points->body.size(), 250U);
    EXPECT_GT(points->ground.size(), 20U);
    EXPECT_LE(points->ground.size(), 50U);
    EXPECT_LT(points->origin.norm(), 1e-5F);
    for (const auto& p : points->ground) EXPECT_NEAR(p.z(), -1.73F, 0.12F);
    for (const auto& p : points->body) {
        const Vec3 p_car = kCar.inverse() * p.cast<double>();
        EXPECT_TRUE(geometry::Cuboid{kSize}.contains(p_car, 0.1)) << p_car.transpose();
        EXPECT_GT(p.z(), -1.73F + 0.1F);
    }
}

TEST(PointGatherer, keepsToItsLimits) {
    const auto points = PointGatherer(street()).gather(kCar, kSize, {0.5, 40, 10});
    ASSERT_TRUE(points);
    EXPECT_LE(points->body.size(), 40U);
    EXPECT_GT(points->body.size(), 15U);
    EXPECT_LE(points->ground.size(), 10U);
}

TEST(PointGatherer, thereIsNothingWhereNothingStands) {
    const auto scan = street();
    const PointGatherer gatherer(scan);
    EXPECT_FALSE(gatherer.gather(SE3::fromYaw(0, {20, 8, -1}), kSize, {}));
    EXPECT_FALSE(gatherer.gather(SE3::fromYaw(0, {400, 8, -1}), kSize, {}));
}

TEST(PointGatherer, pointsSpeakInTheFrameOfTheDetectionsSensor) {
    const auto scan = street();
    obs::CObservationDetectedObjects objects;
    const SE3 T_vehicle_sensor = SE3::fromYaw(-0.2, {0.5, 0.1, 1.6});
    objects.sensorPose = geometry::toCPose3D(T_vehicle_sensor);
    obs::ObjectDetection d;
    d.size_m = kSize;
    d.T_sensor_obj = T_vehicle_sensor.inverse() * scan.T_vehicle_velo * kCar;
    objects.detections = {d, d, d};
    const auto kept = std::make_shared<obs::ObjectPoints>();
    objects.detections[1].points = kept;
    objects.detections[2].size_m.setZero();
    gatherPoints(objects, scan, {});
    ASSERT_TRUE(objects.detections[0].points);
    EXPECT_EQ(objects.detections[1].points, kept);
    EXPECT_FALSE(objects.detections[2].points);
    for (const auto& p : objects.detections[0].points->body) {
        const Vec3 p_car = d.T_sensor_obj.inverse() * p.cast<double>();
        EXPECT_TRUE(geometry::Cuboid{kSize}.contains(p_car, 0.1)) << p_car.transpose();
    }
}

}  // namespace
}  // namespace djpete::observers
