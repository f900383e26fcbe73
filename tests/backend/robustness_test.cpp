/// Input that is poor, broken or hostile.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "djpete/backend/map_keeper.h"
#include "djpete/obs/errors.h"
#include "djpete_test/synthetic_drive.h"
#include "map_bytes.h"

namespace djpete::backend {
namespace {

using djpete_test::cameraNumbers;
using djpete_test::DriveOptions;
using djpete_test::makeDrive;
using djpete_test::sameBytes;
using geometry::SE3;
using geometry::Vec3;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

DriveOptions shortDrive() {
    DriveOptions o;
    o.frames = 40;
    return o;
}

uint64_t rejected(const MapKeeper& keeper) {
    uint64_t n = 0;
    for (const auto& [why, count] : keeper.statistics().rejected) n += count;
    return n;
}

TEST(Robustness, rubbishDetectionsAreCountedAndTheRestIsUsed) {
    auto clean = makeDrive(shortDrive());
    auto dirty = makeDrive(shortDrive());
    for (auto& f : dirty.frames) {
        obs::ObjectDetection d;
        d.size_m = {4, 2, 1.5};
        d.T_sensor_obj = SE3::fromYaw(0, {20, 0, 0});
        const auto add = [&](auto&& spoil) {
            auto bad = d;
            spoil(bad);
            f.detections->detections.insert(f.detections->detections.begin(), bad);
        };
        add([](auto& x) { x.T_sensor_obj = SE3::fromYaw(0, {kNan, 0, 0}); });
        add([](auto& x) { x.T_sensor_obj = SE3(2 * geometry::Mat3::Identity(), {20, 0, 0}); });
        add([](auto& x) { x.size_m.x() = kNan; });
        add([](auto& x) { x.size_m.y() = -1; });
        add([](auto& x) { x.size_m.z() = 1e9; });
        add([](auto& x) { x.information(2, 3) = kNan; });
        add([](auto& x) { x.information = -x.information; });
        add([](auto& x) { x.information.setZero(); });
        add([](auto& x) { x.score = std::numeric_limits<float>::infinity(); });
        add([](auto& x) { x.T_sensor_obj = SE3::fromYaw(0, {1e12, 0, 0}); });
        add([](auto& x) { x.objectClass = obs::ObjectClass::Pedestrian; });
    }
    MapKeeper a({}, Mode::Lockstep), b({}, Mode::Lockstep);
    for (const auto& f : clean.frames) a.addFrame(f.keyframe, f.detections);
    for (const auto& f : dirty.frames) b.addFrame(f.keyframe, f.detections);
    a.finish();
    b.finish();
    b.map().check();
    EXPECT_EQ(rejected(a), 0U);
    EXPECT_EQ(rejected(b), 40U * 11);
    EXPECT_TRUE(sameBytes(djpete_test::mapNumbers(a.map()), djpete_test::mapNumbers(b.map())));
}

TEST(Robustness, fiveHundredRandomBoxesAFrameLeaveTheCamerasAlone) {
    auto drive = makeDrive(shortDrive());
    drive.frames.resize(12);
    BackendOptions off;
    off.objects.mode = ObjectMode::Off;
    MapKeeper expected(off, Mode::Lockstep), keeper({}, Mode::Lockstep);
    djpete_test::Random random(3);
    for (auto& f : drive.frames) {
        expected.addFrame(f.keyframe, nullptr);
        for (int i = 0; i < 500; ++i) {
            obs::ObjectDetection d;
            d.size_m = {4, 2, 1.5};
            d.T_sensor_obj = SE3::fromYaw(random.uniform(-3, 3),
                                          {random.uniform(3, 80), random.uniform(-40, 40), -1});
            d.score = static_cast<float>(random.uniform());
            f.detections->detections.push_back(d);
        }
        keeper.addFrame(f.keyframe, f.detections);
    }
    expected.finish();
    keeper.finish();
    keeper.map().check();
    EXPECT_TRUE(sameBytes(cameraNumbers(expected.map()), cameraNumbers(keeper.map())));
    EXPECT_GT(keeper.statistics().rejected.at("detection more than a frame may have"), 0U);
}

TEST(Robustness, brokenFeaturesAreCountedAndTheRestIsUsed) {
    auto drive = makeDrive(shortDrive());
    for (auto& f : drive.frames) {
        auto& features = f.keyframe->features;
        if (features.size() < 10) continue;
        features[0].u_px = std::numeric_limits<float>::quiet_NaN();
        features[1].sigma_px = 0;
        features[2].uRight_px = std::numeric_limits<float>::infinity();
        features[3].uRight_px = features[3].u_px + 10;
        features[4].depth_m = -3.F;
        features[5].track = features[6].track;
    }
    MapKeeper keeper({}, Mode::Lockstep);
    for (const auto& f : drive.frames) keeper.addFrame(f.keyframe, f.detections);
    keeper.finish();
    keeper.map().check();
    EXPECT_EQ(rejected(keeper), 6 * keeper.statistics().keyframes);
    EXPECT_EQ(keeper.statistics().backboneFailures, 0U);
}

TEST(Robustness, posesOnlyFollowOdometry) {
    auto drive = makeDrive(shortDrive());
    MapKeeper keeper({}, Mode::Lockstep);
    for (const auto& f : drive.frames) {
        f.keyframe->isKeyframe = false;
        f.keyframe->features.clear();
        keeper.addFrame(f.keyframe, nullptr);
    }
    keeper.finish();
    keeper.map().check();
    EXPECT_EQ(keeper.map().frames().size(), 40U);
    EXPECT_GE(keeper.map().keyframes().size(), 2U);
    for (const auto& f : drive.frames) {
        const SE3 T_world_cam = *keeper.map().cameraAt(f.keyframe->frame);
        EXPECT_LT((T_world_cam.translation() - f.keyframe->T_odom_cam.translation()).norm(), 1e-6);
    }
}

TEST(Robustness, posesAndDetectionsMakeObjects) {
    auto options = shortDrive();
    options.odometrySigma_m = options.odometrySigma_rad = options.odometryScaleError = 0;
    auto drive = makeDrive(options);
    MapKeeper keeper({}, Mode::Threaded);
    for (const auto& f : drive.frames) {
        f.keyframe->isKeyframe = false;
        f.keyframe->features.clear();
        keeper.addFrame(f.keyframe, f.detections);
    }
    keeper.finish();
    keeper.map().check();
    EXPECT_GT(keeper.map().objects().size(), 5U);
}

TEST(Robustness, featuresWithoutAnyDepthDoNotBreakTheMap) {
    auto options = shortDrive();
    options.depth = DriveOptions::Depth::None;
    const auto drive = makeDrive(options);
    MapKeeper keeper({}, Mode::Lockstep);
    for (const auto& f : drive.frames) keeper.addFrame(f.keyframe, f.detections);
    keeper.finish();
    keeper.map().check();
    EXPECT_GT(keeper.map().landmarks().size(), 50U);
    // No better than odometry's scale can be asked; no worse by much, either.
    double worst = 0;
    for (const auto& f : drive.frames) {
        worst = std::max(worst, (keeper.map().cameraAt(f.keyframe->frame)->translation() -
                                 f.T_world_cam.translation())
                                    .norm());
    }
    EXPECT_LT(worst, 3);
}

std::string refusal(MapKeeper& keeper, const obs::CObservationVisualKeyframe::Ptr& frame) {
    try {
        keeper.addFrame(frame, nullptr);
    } catch (const obs::InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Robustness, badFramesAreRefusedInOneSentenceAndTheMapGoesOn) {
    auto drive = makeDrive(shortDrive());
    MapKeeper keeper({}, Mode::Lockstep);
    for (int i = 0; i < 10; ++i) keeper.addFrame(drive.frames[std::size_t(i)].keyframe, nullptr);
    const auto revision = keeper.map().revision();
    const auto refused = [&](uint64_t base, auto&& spoil) {
        auto copy = obs::CObservationVisualKeyframe::Create(*drive.frames[base].keyframe);
        spoil(*copy);
        return refusal(keeper, copy);
    };
    using testing::HasSubstr;
    EXPECT_THAT(refused(9, [](auto&) {}), HasSubstr("frame 9: comes after frame 9"));
    EXPECT_THAT(refused(5, [](auto&) {}), HasSubstr("frame 5: comes after frame 9"));
    EXPECT_THAT(refused(5, [](auto& f) { f.frame = {10}; }), HasSubstr("time stamp"));
    EXPECT_THAT(refused(10, [](auto& f) { f.timestamp = INVALID_TIMESTAMP; }),
                HasSubstr("frame 10"));
    EXPECT_THAT(refused(10, [](auto& f) { f.camera.fx = 0; }), HasSubstr("focal length"));
    EXPECT_THAT(refused(10, [](auto& f) { f.camera.cy = kNan; }), HasSubstr("frame 10"));
    EXPECT_THAT(refused(10,
                        [](auto& f) {
                            f.T_odom_cam = SE3::fromYaw(0, {0, kNan, 0});
                        }),
                HasSubstr("odometry pose"));
    EXPECT_THAT(refused(10, [](auto& f) { f.sensorPose.x(kNan); }), HasSubstr("frame 10"));
    EXPECT_EQ(keeper.map().revision(), revision);
    EXPECT_EQ(keeper.statistics().frames, 10U);
    keeper.addFrame(drive.frames[10].keyframe, nullptr);
    keeper.finish();
    EXPECT_THROW(keeper.addFrame(drive.frames[11].keyframe, nullptr), std::logic_error);
    EXPECT_THROW(keeper.addFrame(nullptr, nullptr), std::logic_error);
}

TEST(Robustness, finishWithoutAFrame) {
    MapKeeper keeper({}, Mode::Threaded);
    keeper.finish();
    keeper.finish();
    EXPECT_TRUE(keeper.map().frames().empty());
}

TEST(Robustness, aWorkersExceptionReachesTheOwner) {
    const auto drive = makeDrive(shortDrive());
    for (const Mode mode : {Mode::Lockstep, Mode::Threaded}) {
        for (const std::string which : {"backbone", "objects"}) {
            MapKeeper keeper({}, mode, [&](const char* worker) {
                if (worker == which) throw std::runtime_error("broken " + which);
            });
            std::string said;
            try {
                for (const auto& f : drive.frames) keeper.addFrame(f.keyframe, f.detections);
            } catch (const std::runtime_error& e) {
                said = e.what();
            }
            EXPECT_EQ(said, "broken " + which);
            keeper.map().check();
        }
    }
}

}  // namespace
}  // namespace djpete::backend
