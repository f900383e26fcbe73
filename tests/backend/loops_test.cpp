/// Loops, lost cameras and maps that go on, on made-up drives.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "djpete/backend/map_keeper.h"
#include "djpete_test/synthetic_drive.h"
#include "map_bytes.h"

namespace djpete::backend {
namespace {

using djpete_test::cameraNumbers;
using djpete_test::DriveOptions;
using djpete_test::makeDrive;
using djpete_test::mapNumbers;
using djpete_test::sameBytes;
using djpete_test::SyntheticDrive;
using geometry::SE3;

/// A circle of 201 m, a little more than once round.
DriveOptions circle() {
    DriveOptions o;
    o.frames = 300;
    o.yawRate_radps = 0.25;
    o.descriptors = true;
    o.circle = true;
    o.odometrySigma_rad = 0.003;
    o.movingCars = 0;
    return o;
}

std::unique_ptr<MapKeeper> run(const SyntheticDrive& drive, const BackendOptions& options = {},
                               Mode mode = Mode::Lockstep, MapKeeper::BeforeSolve before = {}) {
    auto keeper = std::make_unique<MapKeeper>(options, mode, std::move(before));
    for (const auto& f : drive.frames) {
        keeper->addFrame(f.keyframe, f.detections);
        keeper->map().check();
    }
    keeper->finish();
    keeper->map().check();
    return keeper;
}

/// The camera of `frame` of the map against the truth, both seen from that of frame `from`.
SE3 errorAt(const SyntheticDrive& drive, const map::SlamMap& map, uint64_t from, uint64_t frame,
            uint64_t offset = 0) {
    const SE3 truth = drive.frames[from].T_world_cam.inverse() * drive.frames[frame].T_world_cam;
    const SE3 estimate = map.cameraAt({from + offset})->inverse() * *map.cameraAt({frame + offset});
    return truth.inverse() * estimate;
}

void expectTrueLoops(const SyntheticDrive& drive, const std::vector<map::LoopRecord>& loops) {
    for (const auto& loop : loops) {
        const SE3 truth =
            drive.frames[loop.olderFrame.value % map::kFramesPerDrive].T_world_cam.inverse() *
            drive.frames[loop.newerFrame.value % map::kFramesPerDrive].T_world_cam;
        const SE3 error = truth.inverse() * loop.T_older_newer;
        EXPECT_LT(error.translation().norm(), 0.3);
        EXPECT_LT(error.angle_rad(), 0.02);
    }
}

/// Without local adjustment odometry drifts by metres until the loop closes.
TEST(Loops, aSecondVisitClosesTheLoop) {
    const auto drive = makeDrive(circle());
    BackendOptions open, bent;
    open.backbone.enabled = bent.backbone.enabled = false;
    open.recognition.loops.enabled = false;
    const auto drifted = run(drive, open);
    const auto closed = run(drive, bent);
    EXPECT_EQ(drifted->loops().size(), 0U);
    EXPECT_GE(closed->statistics().loopsClosed, 1U);
    expectTrueLoops(drive, closed->loops());
    // Frame 290 stands where frame 39 stood.
    const double before = errorAt(drive, drifted->map(), 39, 290).translation().norm();
    const double after = errorAt(drive, closed->map(), 39, 290).translation().norm();
    EXPECT_GT(before, 1.0);
    EXPECT_LT(after, 0.15);
    // The far side of the circle comes along.
    const double far = errorAt(drive, drifted->map(), 0, 125).translation().norm();
    EXPECT_LT(errorAt(drive, closed->map(), 0, 125).translation().norm(), far);
}

TEST(Loops, allKeyframesAreAdjustedAfterALoop) {
    const auto drive = makeDrive(circle());
    BackendOptions options;
    options.recognition.loops.bendAbove_m = 0;
    const auto keeper = run(drive, options);
    EXPECT_GE(keeper->statistics().fullAdjustments, 1U);
    EXPECT_GT(keeper->statistics().landmarksFused, 100U);
    BackendOptions open;
    open.recognition.loops.enabled = false;
    const auto drifted = run(drive, open);
    EXPECT_LT(errorAt(drive, keeper->map(), 39, 290).translation().norm(),
              errorAt(drive, drifted->map(), 39, 290).translation().norm());
}

TEST(Loops, carsSeenOnBothVisitsAreOneObject) {
    const auto drive = makeDrive(circle());
    const auto keeper = run(drive);
    unsigned seen = 0;
    for (const unsigned n : drive.seen) seen += n >= 20 ? 1 : 0;
    EXPECT_GT(seen, 10U);
    EXPECT_GE(keeper->map().objects().size(), seen);
    EXPECT_LE(keeper->map().objects().size(), drive.cars.size());
}

TEST(Loops, withoutASecondVisitThereIsNone) {
    auto options = circle();
    options.yawRate_radps = 0.01;
    options.frames = 200;
    const auto drive = makeDrive(options);
    const auto keeper = run(drive);
    EXPECT_EQ(keeper->loops().size(), 0U);
    EXPECT_EQ(keeper->statistics().loopsClosed, 0U);
}

TEST(Loops, threadedGivesTheBytesOfLockstepWhateverTheScheduler) {
    const auto drive = makeDrive(circle());
    const auto lockstep = run(drive);
    std::atomic<unsigned> n{0};
    const auto delay = [&n](const char*) {
        std::this_thread::sleep_for(std::chrono::microseconds(300 * (++n % 7)));
    };
    const auto threaded = run(drive, {}, Mode::Threaded, delay);
    EXPECT_TRUE(sameBytes(mapNumbers(lockstep->map()), mapNumbers(threaded->map())));
    EXPECT_EQ(lockstep->loops().size(), threaded->loops().size());
}

/// From `frame` on the camera is back where it was `jump` frames ago, and odometry did not see how.
void kidnap(SyntheticDrive& drive, std::size_t frame, std::size_t jump) {
    const SE3 T_before_odom = drive.frames[frame - 1].keyframe->T_odom_cam;
    std::vector<djpete_test::DriveFrame> later(
        drive.frames.begin() + static_cast<std::ptrdiff_t>(frame - jump), drive.frames.end());
    drive.frames.resize(frame);
    const SE3 T_first = later.front().keyframe->T_odom_cam;
    for (std::size_t i = 0; i < later.size(); ++i) {
        auto& f = later[i];
        auto kf = obs::CObservationVisualKeyframe::Create();
        *kf = *f.keyframe;
        kf->frame = {frame + i};
        kf->timestamp = mrpt::Clock::fromDouble(1.3e9 + 0.1 * static_cast<double>(frame + i));
        kf->T_odom_cam = T_before_odom * T_first.inverse() * kf->T_odom_cam;
        kf->tracked = i > 0;
        if (i == 0) kf->isKeyframe = true;
        for (auto& feature : kf->features) feature.track.value += 1'000'000'000;
        f.keyframe = kf;
        f.detections = nullptr;
        drive.frames.push_back(std::move(f));
    }
}

TEST(Relocalisation, aKidnappedCameraFindsItselfWithinTenFrames) {
    auto options = circle();
    options.frames = 150;
    auto drive = makeDrive(options);
    kidnap(drive, 120, 60);  // frame 120 is a keyframe where frame 60 was
    MapKeeper keeper({}, Mode::Lockstep);
    std::size_t found = 0;
    for (std::size_t i = 0; i < drive.frames.size(); ++i) {
        keeper.addFrame(drive.frames[i].keyframe, drive.frames[i].detections);
        if (i == 120) {
            EXPECT_NE(keeper.map().lastKeyframe()->world, 0U);
        }
        if (found == 0 && keeper.statistics().worldsJoined > 0) found = i;
    }
    keeper.finish();
    keeper.map().check();
    EXPECT_GT(found, 120U);
    EXPECT_LE(found, 130U);
    EXPECT_EQ(keeper.map().lastKeyframe()->world, 0U);
    EXPECT_LT(errorAt(drive, keeper.map(), 60, 150).translation().norm(), 0.15);
    expectTrueLoops(drive, keeper.loops());
}

/// The same drive again, a day later, with numbers of its own.
SyntheticDrive again(const DriveOptions& options) {
    auto drive = makeDrive(options);
    for (auto& f : drive.frames) {
        f.keyframe->frame.value += map::kFramesPerDrive;
        f.keyframe->timestamp += std::chrono::hours(24);
        f.detections->timestamp = f.keyframe->timestamp;
    }
    return drive;
}

TEST(Maps, aSecondDriveFindsItselfInTheFirstAndCarsAreMatched) {
    auto options = circle();
    options.frames = 120;
    const auto first = makeDrive(options);
    const auto base = run(first);
    const auto second = again(options);
    MapKeeper keeper({}, Mode::Lockstep);
    keeper.continueFrom(base->map(), false);
    std::size_t found = 0;
    for (std::size_t i = 0; i < second.frames.size(); ++i) {
        keeper.addFrame(second.frames[i].keyframe, second.frames[i].detections);
        if (found == 0 && keeper.statistics().worldsJoined > 0) found = i;
    }
    keeper.finish();
    keeper.map().check();
    EXPECT_GT(found, 0U);
    EXPECT_LE(found, 10U);
    expectTrueLoops(first, keeper.loops());
    // Both drives went the same way.
    for (const uint64_t frame : {0U, 60U, 119U}) {
        const SE3 error = keeper.map().cameraAt({frame})->inverse() *
                          *keeper.map().cameraAt({frame + map::kFramesPerDrive});
        EXPECT_LT(error.translation().norm(), 0.15) << frame;
    }
    EXPECT_EQ(keeper.map().objects().size(), base->map().objects().size());
}

TEST(Maps, localisingLeavesTheMapAsItWas) {
    auto options = circle();
    options.frames = 90;
    const auto base = run(makeDrive(options));
    const auto second = again(options);
    MapKeeper keeper({}, Mode::Lockstep);
    keeper.continueFrom(base->map(), true);
    for (const auto& f : second.frames) keeper.addFrame(f.keyframe, f.detections);
    keeper.finish();
    EXPECT_EQ(keeper.statistics().worldsJoined, 1U);
    for (const auto& [id, kf] : base->map().keyframes()) {
        EXPECT_EQ(keeper.map().keyframes().at(id).T_world_cam.matrix(), kf.T_world_cam.matrix());
    }
}

TEST(Maps, aBaseAfterAFrameIsABug) {
    const auto drive = makeDrive(circle());
    MapKeeper keeper({}, Mode::Lockstep);
    keeper.addFrame(drive.frames[0].keyframe, nullptr);
    EXPECT_THROW(keeper.continueFrom({}, false), std::logic_error);
}

}  // namespace
}  // namespace djpete::backend
