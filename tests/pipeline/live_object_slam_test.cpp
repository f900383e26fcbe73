#include "djpete/pipeline/live_object_slam.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <atomic>
#include <future>
#include <thread>

#include "../backend/map_bytes.h"
#include "djpete/obs/frame_assembler.h"
#include "djpete/observers/recorded_observer.h"
#include "djpete_test/synthetic_drive.h"

namespace djpete::pipeline {
namespace {

using djpete_test::mapNumbers;
using mrpt::obs::CObservation;
using testing::ElementsAre;
using testing::HasSubstr;
using Observations = std::vector<CObservation::Ptr>;

constexpr unsigned kFrames = 40;

obs::RigCamera rig() { return {djpete_test::kittiCamera(), djpete_test::kittiCameraOnVehicle()}; }

mrpt::Clock::time_point stampOf(double frame) {
    return mrpt::Clock::fromDouble(1.3e9 + 0.1 * frame);
}

mrpt::obs::CObservationRobotPose::Ptr poseOf(const geometry::SE3& T_world_vehicle,
                                             mrpt::Clock::time_point stamp) {
    auto o = mrpt::obs::CObservationRobotPose::Create();
    o->timestamp = stamp;
    o->pose.mean = geometry::toCPose3D(T_world_vehicle);
    return o;
}

enum class Way { Poses, Keyframes };

/// A drive without images, in the order a robot would deliver it: each frame's way (true poses, or
/// recorded keyframes with features) and what was detected in it.
Observations driveOf(Way way, uint64_t seed = 1) {
    djpete_test::DriveOptions options;
    options.frames = kFrames;
    options.seed = seed;
    const geometry::SE3 T_cam_vehicle = rig().T_vehicle_cam.inverse();
    Observations out;
    for (const auto& frame : djpete_test::makeDrive(options).frames) {
        const auto stamp = frame.keyframe->timestamp;
        if (way == Way::Poses) {
            out.push_back(poseOf(frame.T_world_cam * T_cam_vehicle, stamp));
        } else {
            out.push_back(frame.keyframe);
        }
        out.push_back(frame.detections);
    }
    return out;
}

/// `n` frames of a straight way, one observation each.
Observations straightWay(int n) {
    Observations out;
    for (int i = 0; i < n; ++i) {
        out.push_back(poseOf(geometry::SE3::fromYaw(0, {0.8 * i, 0, 0}), stampOf(i)));
    }
    return out;
}

std::unique_ptr<observers::ObjectObserver> recorded() {
    return std::make_unique<observers::RecordedObserver>();
}

ObjectSlamOptions slamOptions(const char* mode = "threaded") {
    ObjectSlamOptions options;
    options.pipeline.mode = mode;
    return options;
}

LiveOptions offline() {
    LiveOptions live;
    live.block = true;
    live.rig = rig();
    return live;
}

void feed(LiveObjectSlam& slam, const Observations& observations) {
    for (const auto& o : observations) slam.processObservation(o);
}

/// The same drive through ObjectSlam itself, in lockstep.
std::vector<double> directly(const Observations& observations) {
    ObjectSlam slam(slamOptions("lockstep"), recorded());
    slam.setRig(rig());
    obs::FrameAssembler frames;
    for (const auto& o : observations) {
        if (const auto frame = frames.add(o)) slam.process(loadFrame(*frame));
    }
    slam.process(loadFrame(*frames.flush()));
    slam.finish();
    EXPECT_GE(slam.map().objects().size(), 3U);
    return mapNumbers(slam.map());
}

std::vector<uint64_t> frameNumbers(const map::SlamMap& map) {
    std::vector<uint64_t> out;
    for (const auto& [frame, pose] : map.frames()) out.push_back(frame.value);
    return out;
}

class LiveObjectSlamDrive : public testing::TestWithParam<Way> {};

TEST_P(LiveObjectSlamDrive, GivesTheMapThatObjectSlamGives) {
    const auto drive = driveOf(GetParam());
    LiveObjectSlam slam(slamOptions(), recorded(), offline());
    EXPECT_TRUE(slam.snapshot()->frames().empty());
    feed(slam, drive);
    slam.shutdown();
    EXPECT_EQ(slam.error(), std::nullopt);
    EXPECT_EQ(slam.droppedFrames(), 0U);
    const auto expected = directly(drive);
    EXPECT_TRUE(djpete_test::sameBytes(mapNumbers(slam.result().map()), expected));
    EXPECT_TRUE(djpete_test::sameBytes(mapNumbers(*slam.snapshot()), expected));
}

INSTANTIATE_TEST_SUITE_P(Ways, LiveObjectSlamDrive, testing::Values(Way::Poses, Way::Keyframes));

TEST(LiveObjectSlam, TwoInstancesDoNotMeet) {
    const auto a = driveOf(Way::Keyframes, 1), b = driveOf(Way::Poses, 2);
    LiveObjectSlam slamA(slamOptions(), recorded(), offline());
    LiveObjectSlam slamB(slamOptions(), recorded(), offline());
    std::thread driver([&] { feed(slamA, a); });
    feed(slamB, b);
    driver.join();
    slamA.shutdown();
    slamB.shutdown();
    EXPECT_TRUE(djpete_test::sameBytes(mapNumbers(*slamA.snapshot()), directly(a)));
    EXPECT_TRUE(djpete_test::sameBytes(mapNumbers(*slamB.snapshot()), directly(b)));
}

TEST(LiveObjectSlam, CallbacksComeInOrderOnTheWorker) {
    LiveObjectSlam slam(slamOptions(), recorded(), offline());
    const auto caller = std::this_thread::get_id();
    uint64_t next = 0, objects = 0;
    slam.onFrame([&](const FrameOutcome& outcome, const map::MapSnapshot& map) {
        EXPECT_NE(std::this_thread::get_id(), caller);
        EXPECT_FALSE(slam.error());  // no lock is held
        EXPECT_EQ(outcome.frame.value, next++);
        EXPECT_TRUE(map);
        EXPECT_TRUE(!outcome.keyframe || map->cameraAt(outcome.frame));
        objects = map->objects().size();
    });
    feed(slam, driveOf(Way::Keyframes));
    slam.shutdown();
    EXPECT_EQ(next, kFrames);
    EXPECT_GE(objects, 3U);
}

TEST(LiveObjectSlam, GoesOnFromAMapAndSaysWhenItKnowsItsPlace) {
    djpete_test::DriveOptions options;
    options.frames = kFrames;
    options.descriptors = true;
    Observations drive;
    for (const auto& frame : djpete_test::makeDrive(options).frames)
        drive.push_back(frame.keyframe);
    const auto ride = [&](map::MapSnapshot base, bool localiseOnly) {
        LiveOptions live = offline();
        live.base = std::move(base);
        live.localiseOnly = localiseOnly;
        std::vector<bool> localised;
        LiveObjectSlam slam(slamOptions(), nullptr, live);
        slam.onFrame([&](const FrameOutcome& outcome, const map::MapSnapshot&) {
            localised.push_back(outcome.localised);
        });
        for (const auto& o : drive) slam.processObservation(o);
        slam.shutdown();
        EXPECT_FALSE(slam.error());
        return std::make_pair(slam.snapshot(), localised);
    };
    const auto [first, knownFirst] = ride(nullptr, false);
    EXPECT_THAT(knownFirst, testing::Each(true));
    const auto [second, knownSecond] = ride(first, true);
    ASSERT_EQ(knownSecond.size(), kFrames);
    EXPECT_FALSE(knownSecond.front());
    EXPECT_TRUE(knownSecond.back());
    EXPECT_EQ(second->frames().size(), 2 * kFrames);
}

TEST(LiveObjectSlam, TheMapIsCopiedAsOftenAsAsked) {
    auto live = offline();
    live.snapshotKeyframes = 3;
    LiveObjectSlam slam(slamOptions(), nullptr, live);
    std::vector<std::size_t> keyframesInCopies;
    slam.onFrame([&](const FrameOutcome&, const map::MapSnapshot& map) {
        const auto n = map->keyframes().size();
        if (keyframesInCopies.empty() || keyframesInCopies.back() != n) {
            keyframesInCopies.push_back(n);
        }
    });
    feed(slam, straightWay(17));  // every other frame is a keyframe: 9
    slam.shutdown();
    EXPECT_THAT(keyframesInCopies, ElementsAre(1, 4, 7));
    EXPECT_EQ(slam.snapshot()->keyframes().size(), 9U);
}

TEST(LiveObjectSlam, AnUnusableFrameEndsItWithASentence) {
    for (const bool block : {true, false}) {
        auto live = offline();
        live.block = block;
        live.queueLength = 100;
        LiveObjectSlam slam(slamOptions(), nullptr, live);
        auto way = straightWay(20);
        auto image = mrpt::obs::CObservationImage::Create();
        image->timestamp = stampOf(7);
        image->cameraParams.setIntrinsicParamsFromValues(700, 700, 600, 180);
        image->image.setExternalStorage("/no/such/picture.png");
        way.insert(way.begin() + 7, image);
        feed(slam, way);
        slam.shutdown();
        ASSERT_TRUE(slam.error());
        EXPECT_THAT(*slam.error(), HasSubstr("/no/such/picture.png"));
        EXPECT_THAT(frameNumbers(*slam.snapshot()), ElementsAre(0, 1, 2, 3, 4, 5, 6));
        EXPECT_EQ(slam.result().map().frames().size(), 7U);
        EXPECT_EQ(slam.droppedFrames(), 0U);
    }
}

TEST(LiveObjectSlam, AfterAnErrorABlockedProducerGoesOn) {
    auto live = offline();
    live.queueLength = 1;
    live.rig.reset();  // nothing can be done without the camera
    LiveObjectSlam slam(slamOptions(), nullptr, live);
    feed(slam, straightWay(200));
    slam.shutdown();
    ASSERT_TRUE(slam.error());
    EXPECT_THAT(*slam.error(), HasSubstr("frame 0"));
    EXPECT_TRUE(slam.snapshot()->frames().empty());
}

TEST(LiveObjectSlam, WhatACallbackThrowsEndsIt) {
    LiveObjectSlam slam(slamOptions(), nullptr, offline());
    slam.onFrame([](const FrameOutcome& outcome, const map::MapSnapshot&) {
        if (outcome.frame.value == 3) throw std::runtime_error("no more room on disk");
    });
    feed(slam, straightWay(10));
    slam.shutdown();
    EXPECT_EQ(slam.error(), "no more room on disk");
    EXPECT_EQ(slam.snapshot()->frames().size(), 4U);
}

/// A worker that stands still in its first frame until it is let go.
struct Gate {
    std::promise<void> entered, opened;
    void holdFirstFrameOf(LiveObjectSlam& slam) {
        slam.onFrame([this](const FrameOutcome& outcome, const map::MapSnapshot&) {
            if (outcome.frame.value != 0) return;
            entered.set_value();
            opened.get_future().wait();
        });
    }
};

TEST(LiveObjectSlam, NewFramesAreDroppedAndCountedWhileTheQueueIsFull) {
    auto live = offline();
    live.block = false;
    live.queueLength = 2;
    LiveObjectSlam slam(slamOptions(), nullptr, live);
    Gate gate;
    gate.holdFirstFrameOf(slam);
    const auto way = straightWay(11);
    feed(slam, {way[0], way[1]});
    gate.entered.get_future().wait();
    feed(slam, {way.begin() + 2, way.end()});  // 1 and 2 wait, 3 to 9 find no room
    EXPECT_EQ(slam.droppedFrames(), 7U);
    gate.opened.set_value();
    slam.shutdown();  // 10 is complete now; it waits for room
    EXPECT_EQ(slam.droppedFrames(), 7U);
    EXPECT_EQ(slam.error(), std::nullopt);
    EXPECT_THAT(frameNumbers(*slam.snapshot()), ElementsAre(0, 1, 2, 10));
}

TEST(LiveObjectSlam, BlockingDropsNothing) {
    auto live = offline();
    live.queueLength = 1;
    LiveObjectSlam slam(slamOptions(), nullptr, live);
    Gate gate;
    gate.holdFirstFrameOf(slam);
    std::atomic<bool> fed{false};
    std::thread driver([&] {
        feed(slam, straightWay(11));
        fed = true;
    });
    gate.entered.get_future().wait();
    EXPECT_FALSE(fed);
    gate.opened.set_value();
    driver.join();
    slam.shutdown();
    EXPECT_EQ(slam.snapshot()->frames().size(), 11U);
    EXPECT_EQ(slam.droppedFrames(), 0U);
}

TEST(LiveObjectSlam, WhatComesTooLateIsDroppedAndCounted) {
    LiveObjectSlam slam(slamOptions(), nullptr, offline());
    auto way = straightWay(6);
    std::swap(way[2], way[4]);  // stamps 0 1 4 3 2 5
    feed(slam, way);
    slam.shutdown();
    EXPECT_EQ(slam.droppedFrames(), 2U);
    EXPECT_EQ(slam.error(), std::nullopt);
    EXPECT_EQ(slam.snapshot()->frames().size(), 4U);
}

TEST(LiveObjectSlam, SensorsBetweenTheFramesArePassedOver) {
    LiveObjectSlam slam(slamOptions(), nullptr, offline());
    for (int i = 0; i < 5; ++i) {
        auto gps = mrpt::obs::CObservationGPS::Create();
        gps->timestamp = stampOf(i + 0.5);
        slam.processObservation(straightWay(5)[static_cast<std::size_t>(i)]);
        slam.processObservation(gps);
    }
    slam.shutdown();
    EXPECT_EQ(slam.error(), std::nullopt);
    EXPECT_EQ(slam.droppedFrames(), 0U);
    EXPECT_EQ(slam.snapshot()->frames().size(), 5U);
}

TEST(LiveObjectSlam, TheDestructorProcessesWhatWaits) {
    std::atomic<unsigned> frames{0};
    {
        auto live = offline();
        live.queueLength = 100;
        LiveObjectSlam slam(slamOptions(), recorded(), live);
        slam.onFrame([&](const FrameOutcome&, const map::MapSnapshot&) { ++frames; });
        feed(slam, driveOf(Way::Poses));
    }
    EXPECT_EQ(frames, kFrames);
    { LiveObjectSlam neverUsed(slamOptions(), nullptr); }
}

TEST(LiveObjectSlam, ShutdownIsTheEnd) {
    LiveObjectSlam slam(slamOptions(), nullptr, offline());
    EXPECT_THROW(slam.result(), std::exception);
    feed(slam, straightWay(3));
    std::thread other([&] { slam.shutdown(); });
    slam.shutdown();
    other.join();
    feed(slam, straightWay(9));
    slam.shutdown();
    EXPECT_EQ(slam.result().map().frames().size(), 3U);
    EXPECT_EQ(slam.droppedFrames(), 0U);
}

TEST(LiveObjectSlam, OthersMayLookWhileItWorks) {
    LiveObjectSlam slam(slamOptions(), recorded(), offline());
    std::atomic<bool> done{false};
    std::thread viewer([&] {
        std::size_t before = 0;
        while (!done) {
            const auto map = slam.snapshot();
            EXPECT_GE(map->keyframes().size(), before);
            before = map->keyframes().size();
            EXPECT_NO_THROW(map->check());
            EXPECT_FALSE(slam.error());
            std::this_thread::yield();
        }
    });
    feed(slam, driveOf(Way::Keyframes));
    slam.shutdown();
    done = true;
    viewer.join();
    EXPECT_EQ(slam.snapshot()->frames().size(), kFrames);
}

TEST(LiveObjectSlam, OptionsOutOfRangeAreToldAtOnce) {
    auto options = slamOptions();
    options.backend.keeper.maxFramesPerKeyframe = 0;
    EXPECT_THROW(LiveObjectSlam(options, nullptr), std::exception);
}

}  // namespace
}  // namespace djpete::pipeline
