/// The geometric observer on real scans.
#include <gtest/gtest.h>

#include "djpete/observers/geometric_observer.h"
#include "djpete_test/shared_data.h"
#include "kitti_scene.h"

namespace {

using namespace djpete;
using namespace djpete_test;

TEST(GeometricObserverOnKitti, FindsTheLabelledCarsOfDrive0005) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti");
    const auto day = kitti / "raw/2011_09_26";
    const auto camera = readRawCamera(day);
    const auto labels =
        readTrackingLabels(kitti / "tracking/training/label_02/0000.txt", camera.T_vehicle_cam);
    const observers::GeometricObserver observer;
    DetectionTally near, far;
    for (int frame = 0; frame < 25; ++frame) {
        const auto scan = readKittiScan(day / "2011_09_26_drive_0005_sync/velodyne_points/data" /
                                        (kittiNumber(frame, 10) + ".bin"));
        ASSERT_GT(scan.points.size(), 100000U);
        const auto detections = observer.detect(scan, &camera);
        addFrame(near, labels.at(frame), detections, camera, 0, 25);
        addFrame(far, labels.at(frame), detections, camera, 25, 45);
    }
    ASSERT_EQ(near.labels, 25);
    EXPECT_GE(near.recall(), 0.9);
    EXPECT_GE(near.precision(), 0.8);
    EXPECT_LE(near.medianCentre_m(), 0.3);
    EXPECT_LE(near.medianYaw_rad(), 2 * M_PI / 180);
    // Sigmas are of the size of the errors: not over-confident by more than half.
    double sum = 0;
    for (const auto& f : near.found) sum += f.normalised.head<2>().squaredNorm() / 2;
    EXPECT_LT(std::sqrt(sum / static_cast<double>(near.found.size())), 1.5);
    RecordProperty("recall_25m", std::to_string(near.recall()));
    RecordProperty("precision_25m", std::to_string(near.precision()));
    RecordProperty("recall_25_45m", std::to_string(far.recall()));
}

/// A regression test without labels: these parked cars are plain to see in the images of odometry
/// 00, and projected boxes were checked against them by eye. Centres in velo of the frame.
TEST(GeometricObserverOnKitti, FindsParkedCarsOfOdometry00) {
    DJPETE_SHARED_OR_SKIP(sequence, "data/kitti/odometry/sequences/00");
    const observers::GeometricObserver observer;
    struct Parked {
        int frame;
        double x, y;
        const char* what;
    };
    const Parked cars[] = {{0, 9.1, -3.0, "dark hatchback on the right"},
                           {0, 24.9, 9.1, "red car on the left"},
                           {5, 5.5, -3.2, "dark hatchback on the right"},
                           {5, 21.4, 8.5, "red car on the left"}};
    for (const auto& car : cars) {
        const auto scan =
            readKittiScan(sequence / "velodyne" / (kittiNumber(car.frame, 6) + ".bin"));
        double nearest = 1e9;
        for (const auto& d : observer.detect(scan, nullptr)) {
            const auto p = d.T_sensor_obj.translation();
            nearest = std::min(nearest, std::hypot(p.x() - car.x, p.y() - car.y));
        }
        EXPECT_LT(nearest, 0.6) << car.what << ", frame " << car.frame;
    }
}

}  // namespace
