/// What the geometric observer promises, on scans whose truth is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "djpete/obs/options.h"
#include "djpete/observers/geometric_observer.h"
#include "synthetic_scan.h"

namespace {

using namespace djpete;
using djpete_test::Block;
using djpete_test::SyntheticStreet;
using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;
using observers::GeometricObserver;

constexpr double kDegree = M_PI / 180;

std::vector<obs::ObjectDetection> detect(const SyntheticStreet& street) {
    return GeometricObserver().detect(street.scan(), nullptr);
}

/// Distance in the ground plane, and angle between lengthwise axes, to the nearest detection.
struct Nearest {
    double distance_m = 1e9, yaw_rad = 0;
    const obs::ObjectDetection* detection = nullptr;
};

Nearest nearestTo(double x, double y, double yaw_rad,
                  const std::vector<obs::ObjectDetection>& detections) {
    Nearest out;
    for (const auto& d : detections) {
        const double distance = (d.T_sensor_obj.translation().head<2>() - Vec2(x, y)).norm();
        if (distance >= out.distance_m) continue;
        const double turn = std::abs(geometry::wrapAngle(d.T_sensor_obj.yaw_rad() - yaw_rad));
        out = {distance, std::min(turn, M_PI - turn), &d};
    }
    return out;
}

struct CarCase {
    double x, y, yaw_deg;
};

class OneCar : public testing::TestWithParam<CarCase> {};

TEST_P(OneCar, IsFoundWithItsCentreAndYaw) {
    const auto [x, y, yaw_deg] = GetParam();
    SyntheticStreet street;
    street.addCar(x, y, yaw_deg * kDegree);
    const auto detections = detect(street);
    ASSERT_EQ(detections.size(), 1U);
    const auto n = nearestTo(x, y, yaw_deg * kDegree, detections);
    EXPECT_LT(n.distance_m, 0.45);
    EXPECT_LT(n.yaw_rad, 4 * kDegree);
    EXPECT_EQ(n.detection->objectClass, obs::ObjectClass::Car);
    EXPECT_NEAR(n.detection->size_m.z(), 1.5, 0.2);
    EXPECT_NEAR(n.detection->T_sensor_obj.translation().z(), -1.73 + 0.75, 0.15);
    EXPECT_GT(n.detection->score, 0.5F);
    EXPECT_LE(n.detection->score, 1.0F);
}

INSTANTIATE_TEST_SUITE_P(AllAround, OneCar,
                         testing::Values(CarCase{10, 4, 0}, CarCase{10, -4, 5}, CarCase{18, 0, 0},
                                         CarCase{15, 6, 90}, CarCase{20, -8, 30},
                                         CarCase{-12, 5, -20}, CarCase{3, 7, 0},
                                         CarCase{-3, -9, 100}, CarCase{28, 5, 10},
                                         CarCase{8, -10, 45}));

TEST(GeometricObserver, CompletesAPartlyHiddenCarAwayFromTheSensor) {
    SyntheticStreet street;
    street.addCar(14, 3, 0);
    street.blocks.push_back({8.5, 2.6, 0, {0.5, 0.5, 2.0}});  // a post box hides a part of the rear
    const auto n = nearestTo(14, 3, 0, detect(street));
    ASSERT_NE(n.detection, nullptr);
    EXPECT_LT(n.distance_m, 0.8);
    EXPECT_LT(n.yaw_rad, 6 * kDegree);
}

TEST(GeometricObserver, TellsACarSeenFromBehindByItsUsualLength) {
    SyntheticStreet street;
    street.addCar(16, 0, 0);
    const auto detections = detect(street);
    ASSERT_EQ(detections.size(), 1U);
    const auto& d = detections.front();
    EXPECT_NEAR(d.size_m.x(), 4.2, 0.3);
    EXPECT_NEAR(d.T_sensor_obj.translation().x(), 16, 0.3);
    // Less is known along the length, whose far end is out of sight, than across.
    EXPECT_LT(d.information(0, 0), d.information(1, 1));
}

TEST(GeometricObserver, KeepsParkedCarsApart) {
    SyntheticStreet street;
    for (int i = 0; i < 4; ++i) street.addCar(6 + 5.0 * i, 4, 0);
    for (int i = 0; i < 4; ++i) street.addCar(8 + 2.6 * i, -6, M_PI / 2);
    const auto detections = detect(street);
    for (int i = 0; i < 4; ++i) {
        EXPECT_LT(nearestTo(6 + 5.0 * i, 4, 0, detections).distance_m, 0.8) << "along, " << i;
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_LT(nearestTo(8 + 2.6 * i, -6, M_PI / 2, detections).distance_m, 0.8)
            << "across, " << i;
    }
    for (std::size_t a = 0; a < detections.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const Vec3 inA =
                detections[a].T_sensor_obj.inverse() * detections[b].T_sensor_obj.translation();
            EXPECT_FALSE(geometry::Cuboid{detections[a].size_m}.contains(inA));
        }
    }
}

TEST(GeometricObserver, TurnsAwayWhatIsNoCar) {
    SyntheticStreet street;
    street.blocks = {
        Block{15, 10, 0, {40, 0.3, 6}},       // house front
        Block{12, -9, 0, {20, 0.2, 1.5}},     // garden wall
        Block{9, 3, 0, {0.2, 0.2, 4}},        // pole
        Block{7, -3, 0, {0.5, 0.5, 1.75}},    // pedestrian
        Block{14, -2, 0.3, {0.6, 0.6, 1.7}},  // another
        Block{18, 4, 0, {1.7, 0.4, 0.9}},     // bicycle rack
        Block{-10, 6, 0, {0.4, 0.4, 5}},      // tree
        Block{-12, -6, 0, {2.5, 2.5, 3.5}},   // kiosk
        Block{-15, 0, 0, {4.0, 1.8, 0.6}},    // flower bed
    };
    for (const auto& d : detect(street)) {
        const Vec3 p = d.T_sensor_obj.translation();
        ADD_FAILURE() << "a car at " << p.transpose() << ", size " << d.size_m.transpose()
                      << ", score " << d.score;
    }
}

TEST(GeometricObserver, FindsCarsBesideWallsAndUnderTrees) {
    SyntheticStreet street;
    street.addCar(12, 5, 0);
    street.blocks.push_back({12, 8, 0, {40, 0.3, 6}});  // 2 m behind the car
    street.addCar(12, -5, 0);
    street.blocks.push_back({12, -5, 0, {3, 3, 2}, 2.6});  // a crown over the car
    const auto detections = detect(street);
    EXPECT_LT(nearestTo(12, 5, 0, detections).distance_m, 0.5);
    const auto underTree = nearestTo(12, -5, 0, detections);
    EXPECT_LT(underTree.distance_m, 0.5);
    EXPECT_NEAR(underTree.detection->size_m.z(), 1.5, 0.2);
}

TEST(GeometricObserver, FollowsTiltedGround) {
    SyntheticStreet street;
    street.T_velo_ground = SE3::exp((geometry::Vec6() << 0, 0, -1.8, 0.05, -0.08, 0).finished());
    street.addCar(8, 4, 0.2);  // uphill; farther up, the topmost beam would miss its roof
    street.addCar(-10, -5, 0.1);
    const auto detections = detect(street);
    ASSERT_EQ(detections.size(), 2U);
    for (std::size_t i : {0U, 2U}) {
        const Block& b = street.blocks[i];
        const SE3 truth = street.T_velo_ground * SE3::fromYaw(b.yaw_rad, {b.x, b.y, 0.75});
        const Vec3 p = truth.translation();
        const auto n = nearestTo(p.x(), p.y(), b.yaw_rad, detections);
        EXPECT_LT((n.detection->T_sensor_obj.translation() - p).norm(), 0.5);
        EXPECT_LT(n.yaw_rad, 5 * kDegree);
        const Vec3 up = n.detection->T_sensor_obj.rotation().col(2);
        EXPECT_LT(std::acos(up.dot(truth.rotation().col(2))), 1.5 * kDegree);
    }
}

TEST(GeometricObserver, CallsHighOnesVans) {
    SyntheticStreet street;
    street.blocks.push_back({13, -4, 0.1, {4.8, 1.9, 1.8}, 0.25});
    const auto detections = detect(street);
    ASSERT_EQ(detections.size(), 1U);
    EXPECT_EQ(detections.front().objectClass, obs::ObjectClass::Van);
}

TEST(GeometricObserver, PointsHeadingsForward) {
    SyntheticStreet street;
    street.addCar(12, 5, M_PI);
    auto scan = street.scan();
    const auto detections = GeometricObserver().detect(scan, nullptr);
    ASSERT_EQ(detections.size(), 1U);
    EXPECT_GT(detections.front().T_sensor_obj.rotation()(0, 0), 0.9);
    scan.T_vehicle_velo = SE3::fromYaw(M_PI, Vec3::Zero());  // a sensor that looks back
    const auto turned = GeometricObserver().detect(scan, nullptr);
    ASSERT_EQ(turned.size(), 1U);
    EXPECT_LT(turned.front().T_sensor_obj.rotation()(0, 0), -0.9);
}

TEST(GeometricObserver, IsSilentWithoutObstaclesOrGround) {
    const GeometricObserver observer;
    EXPECT_TRUE(observer.detect({}, nullptr).empty());
    EXPECT_TRUE(detect(SyntheticStreet()).empty());
    SyntheticStreet floating;
    floating.ground = false;
    floating.blocks.push_back({10, 0, 0, {0.3, 0.3, 3}});
    EXPECT_TRUE(detect(floating).empty());
}

TEST(GeometricObserver, SurvivesAnyPoints) {
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        const float spread = round % 2 == 0 ? 5.F : 60.F;
        std::uniform_real_distribution<float> any(-spread, spread);
        obs::LidarScan scan;
        const int count = round < 4 ? round : 3000 * round;
        for (int i = 0; i < count; ++i) {
            const float z = round % 3 == 0 ? any(random) : 0.02F * any(random);
            scan.points.push_back({any(random), any(random), z, 0});
        }
        if (round == 19) scan.points.assign(5000, {3.F, 3.F, 1.F, 0.F});
        const auto camera = djpete_test::forwardCamera();
        for (const auto& d : GeometricObserver().detect(scan, &camera)) {
            EXPECT_TRUE(d.T_sensor_obj.matrix().allFinite());
            EXPECT_TRUE(d.information.allFinite());
            EXPECT_GE(d.score, 0.F);
            EXPECT_LE(d.score, 1.F);
            EXPECT_TRUE(!d.mask || d.mask->consistent());
        }
    }
}

TEST(GeometricObserver, GivesTheSameTwice) {
    SyntheticStreet street;
    for (int i = 0; i < 3; ++i) street.addCar(7 + 6.0 * i, 4, 0.1 * i);
    street.blocks.push_back({10, -8, 0, {30, 0.3, 5}});
    const auto scan = street.scan();
    const auto camera = djpete_test::forwardCamera();
    const auto a = GeometricObserver().detect(scan, &camera);
    const auto b = GeometricObserver().detect(scan, &camera);
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GE(a.size(), 3U);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].score, b[i].score);
        EXPECT_EQ(a[i].T_sensor_obj.matrix(), b[i].T_sensor_obj.matrix());
        EXPECT_EQ(a[i].mask.has_value(), b[i].mask.has_value());
        if (a[i].mask) {
            EXPECT_EQ(a[i].mask->runs, b[i].mask->runs);
        }
    }
}

TEST(GeometricObserver, MaskAndBoxCoverTheReturnsOfTheCar) {
    SyntheticStreet street;
    street.addCar(12, 2, 0.2);
    const auto scan = street.scan();
    const auto camera = djpete_test::forwardCamera();
    const auto detections = GeometricObserver().detect(scan, &camera);
    ASSERT_EQ(detections.size(), 1U);
    const auto& d = detections.front();
    ASSERT_TRUE(d.mask && d.box);
    ASSERT_TRUE(d.mask->consistent());
    EXPECT_EQ(d.mask->width_px, 1242U);
    EXPECT_EQ(d.mask->height_px, 375U);
    EXPECT_GE(d.box->left, 0.F);
    EXPECT_LE(d.box->right, 1241.F);
    EXPECT_GE(d.box->top, 0.F);
    EXPECT_LE(d.box->bottom, 374.F);
    const auto dense = d.mask->toDense();
    int all = 0, covered = 0;
    for (const auto& p : scan.points) {
        const Vec3 p_obj = d.T_sensor_obj.inverse() * p.position();
        if (!geometry::Cuboid{d.size_m}.contains(p_obj, 0.05) ||
            p_obj.z() < 0.35 - d.size_m.z() / 2)
            continue;
        const Vec2 uv = camera.model.project(camera.T_vehicle_cam.inverse() * p.position());
        if (!camera.model.contains(uv)) continue;
        ++all;
        const auto u = static_cast<std::size_t>(std::lround(uv.x()));
        const auto v = static_cast<std::size_t>(std::lround(uv.y()));
        if (dense[v * 1242 + u] != 0) ++covered;
    }
    ASSERT_GT(all, 500);
    EXPECT_GT(covered, 0.98 * all);
    // No more than the car: its box in the image, and a rim.
    EXPECT_LT(static_cast<double>(d.mask->area_px()), 1.1 * static_cast<double>(d.box->area()));
    EXPECT_GT(static_cast<double>(d.mask->area_px()), 0.5 * static_cast<double>(d.box->area()));
}

TEST(GeometricObserver, GivesNoMaskForWhatTheCameraDoesNotSee) {
    SyntheticStreet street;
    street.addCar(-12, 2, 0.2);
    const auto camera = djpete_test::forwardCamera();
    const auto detections = GeometricObserver().detect(street.scan(), &camera);
    ASSERT_EQ(detections.size(), 1U);
    EXPECT_FALSE(detections.front().mask);
    EXPECT_FALSE(detections.front().box);
}

TEST(GeometricObserver, SaysNothingWithoutAScan) {
    GeometricObserver observer;
    obs::SensorFrame frame;
    EXPECT_EQ(observer.observe(frame, nullptr, nullptr), nullptr);
    frame.stamp = mrpt::Clock::fromDouble(1000.5);
    const auto empty = observer.observe(frame, std::make_unique<obs::LidarScan>().get(), nullptr);
    ASSERT_TRUE(empty);
    EXPECT_EQ(empty->timestamp, frame.stamp);
    EXPECT_EQ(empty->sensorLabel, obs::label::kDetections);
    EXPECT_TRUE(empty->detections.empty());
}

TEST(GeometricObserverOptions, TravelThroughAnIni) {
    observers::GeometricObserverOptions o;
    o.rangeMax_m = 33.25;
    o.toleranceLevels = 2;
    o.maskDilation_m = 0.07;
    mrpt::config::CConfigFileMemory ini;
    o.saveToConfigFile(ini, "geometric_observer");
    observers::GeometricObserverOptions back;
    obs::loadOptions(back, ini, "geometric_observer", "test.ini");
    EXPECT_EQ(back.rangeMax_m, 33.25);
    EXPECT_EQ(back.toleranceLevels, 2);
    EXPECT_EQ(back.maskDilation_m, 0.07);
    ini.write("geometric_observer", "rangeMux_m", 3);
    EXPECT_THROW(obs::loadOptions(back, ini, "geometric_observer", "test.ini"), obs::InputError);
    back.cell_m = 0;
    EXPECT_THROW(GeometricObserver{back}, obs::InputError);
}

}  // namespace
