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

/// Parked cars at the start of odometry 00, read off the scans and the image by hand: centre in the
/// Velodyne frame of frame 0 (metres, to about 0.5 m).
TEST(GeometricObserverOnKitti, FindsParkedCarsOfOdometry00) {
    DJPETE_SHARED_OR_SKIP(sequence, "data/kitti/odometry/sequences/00");
    const observers::GeometricObserver observer;
    int framesWithNearCars = 0;
    for (int frame = 0; frame < 16; ++frame) {
        const auto scan = readKittiScan(sequence / "velodyne" / (kittiNumber(frame, 6) + ".bin"));
        int nearCars = 0;
        for (const auto& d : observer.detect(scan, nullptr)) {
            const auto p = d.T_sensor_obj.translation();
            if (p.x() > -5 && p.x() < 25 && std::abs(p.y()) < 12) ++nearCars;
        }
        if (nearCars >= 2) ++framesWithNearCars;
    }
    EXPECT_GE(framesWithNearCars, 13);
}

}  // namespace
