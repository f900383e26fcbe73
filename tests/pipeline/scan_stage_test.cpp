#include "djpete/pipeline/scan_stage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"

namespace djpete::pipeline {
namespace {

using geometry::SE3;
using geometry::Vec3;

/// A room 41 m long and 17 m wide, seen from `T_world_vehicle` by a scanner in the vehicle's frame.
obs::LidarScan roomFrom(const SE3& T_world_vehicle) {
    obs::LidarScan scan;
    const SE3 T_vehicle_world = T_world_vehicle.inverse();
    const auto add = [&](const Vec3& p_world) {
        const Eigen::Vector3f p = (T_vehicle_world * p_world).cast<float>();
        scan.points.push_back({p.x(), p.y(), p.z(), 0});
    };
    for (double a = -20.4; a < 20.4; a += 0.19) {
        for (double b = -8.4; b < 8.4; b += 0.19) add({a, b, -1.7});
        for (double c = -1.7; c < 4; c += 0.19) {
            add({a, -8.4, c});
            add({a, 8.4, c});
        }
    }
    for (double b = -8.4; b < 8.4; b += 0.19) {
        for (double c = -1.7; c < 4; c += 0.19) {
            add({-20.4, b, c});
            add({20.4, b, c});
        }
    }
    return scan;
}

SE3 cameraOnVehicle() {
    return {geometry::opticalToVehicleAxes().rotation(), Vec3(0.3, 0.1, -0.1)};
}

obs::CObservationVisualKeyframe::Ptr frameAt(uint64_t number, const SE3& T_odom_vehicle,
                                             bool keyframe) {
    auto out = obs::CObservationVisualKeyframe::Create();
    out->frame = {number};
    out->timestamp = mrpt::Clock::fromDouble(1e9 + 0.1 * double(number));
    out->isKeyframe = keyframe;
    out->sensorPose = geometry::toCPose3D(cameraOnVehicle());
    out->T_odom_cam = T_odom_vehicle * cameraOnVehicle();
    return out;
}

SE3 placeAt(uint64_t number) { return SE3::fromYaw(0.01 * double(number), {double(number), 0, 0}); }

/// The motions of a drive through the room with a keyframe every second frame.
std::vector<obs::CObservationVisualKeyframe::Ptr> drive(bool enabled, bool threaded) {
    scans::ScanOptions options;
    options.enabled = enabled;
    ScanStage stage(options, threaded);
    StageTable times;
    std::vector<obs::CObservationVisualKeyframe::Ptr> out;
    for (uint64_t k = 0; k < 9; ++k) {
        const auto scan = roomFrom(placeAt(k));
        // Odometry is wrong by 5 cm in every second keyframe.
        const SE3 wrong = SE3::fromYaw(0, {k % 4 == 0 ? 0.05 : 0, 0, 0});
        const bool without = k == 4;  // the keyframe after it joins on to that before it
        out.push_back(stage.process(
            without ? nullptr : &scan, [&] { return frameAt(k, placeAt(k) * wrong, k % 2 == 0); },
            times));
    }
    return out;
}

TEST(ScanStage, GivesKeyframesTheCamerasMotionSinceTheLastOne) {
    const auto frames = drive(true, true);
    for (uint64_t k = 0; k < frames.size(); ++k) {
        const auto& motion = frames[k]->scanMotion;
        ASSERT_EQ(motion.has_value(), k == 2 || k == 6 || k == 8) << k;
        if (!motion) continue;
        const uint64_t from = k == 6 ? 2 : k - 2;
        EXPECT_EQ(motion->from.value, from);
        const SE3 truth =
            (placeAt(from) * cameraOnVehicle()).inverse() * placeAt(k) * cameraOnVehicle();
        const geometry::Vec6 e = (truth.inverse() * motion->T_from_cam).log();
        EXPECT_LT(e.head<3>().norm(), 0.002) << k;
        EXPECT_LT(e.tail<3>().norm(), 1e-4) << k;
    }
}

TEST(ScanStage, ThreadsChangeNothing) {
    const auto a = drive(true, true), b = drive(true, false);
    for (std::size_t k = 0; k < a.size(); ++k) {
        ASSERT_EQ(a[k]->scanMotion.has_value(), b[k]->scanMotion.has_value());
        if (!a[k]->scanMotion) continue;
        EXPECT_EQ(a[k]->scanMotion->T_from_cam.matrix(), b[k]->scanMotion->T_from_cam.matrix());
        EXPECT_EQ(a[k]->scanMotion->information, b[k]->scanMotion->information);
    }
}

TEST(ScanStage, SwitchedOffItDoesNothing) {
    for (const auto& frame : drive(false, true)) EXPECT_FALSE(frame->scanMotion);
}

TEST(ScanStage, AFrontEndThatThrowsIsHeard) {
    ScanStage stage({}, true);
    StageTable times;
    const auto scan = roomFrom(SE3());
    const auto fails = []() -> obs::CObservationVisualKeyframe::Ptr {
        throw obs::InputError("frame 3: no");
    };
    EXPECT_THROW(stage.process(&scan, fails, times), obs::InputError);
}

}  // namespace
}  // namespace djpete::pipeline
