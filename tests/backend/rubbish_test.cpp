/// Nothing but rubbish for a hundred frames.
#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "djpete/backend/map_keeper.h"
#include "djpete_test/synthetic_drive.h"
#include "input_check.h"
#include "map_bytes.h"

namespace djpete::backend {
namespace {

using djpete_test::cameraNumbers;
using djpete_test::Random;
using djpete_test::sameBytes;
using geometry::SE3;
using geometry::Vec3;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr unsigned kBoxes = 500, kFrames = 100;

/// One box that looks like a car, somewhere ahead of the vehicle.
obs::ObjectDetection somewhere(Random& random) {
    obs::ObjectDetection d;
    d.size_m = {random.uniform(2, 6), random.uniform(1, 3), random.uniform(1, 3)};
    const Vec3 p(random.uniform(3, 80), random.uniform(-40, 40), random.uniform(-2, 1));
    d.T_sensor_obj = SE3::fromYaw(random.uniform(-3, 3), p);
    d.information = obs::diagonalInformation(Vec3::Constant(0.3), Vec3::Constant(0.09));
    d.score = static_cast<float>(random.uniform());
    return d;
}

/// Why a box is refused, as the statistics say it.
constexpr const char* kBadPose = "detection with a pose that is not a rigid motion";
constexpr const char* kBadSize = "detection with an impossible size";
constexpr const char* kBadInformation = "detection whose information is not a positive matrix";

/// Of each hundred boxes twenty are broken, in four ways.
void spoil(obs::ObjectDetection& d, unsigned i) {
    if (i % 20 == 0) d.information(int(i / 20) % 6, 2) = kNan;
    if (i % 20 == 5) d.T_sensor_obj = SE3::fromYaw(kNan, d.T_sensor_obj.translation());
    if (i % 20 == 10) d.T_sensor_obj.translation().x() = kNan;
    if (i % 20 == 15) d.size_m[int(i / 20) % 3] = 0;
}

std::vector<obs::ObjectDetection> rubbish(Random& random) {
    std::vector<obs::ObjectDetection> out;
    for (unsigned i = 0; i < kBoxes; ++i) {
        out.push_back(somewhere(random));
        spoil(out.back(), i);
    }
    return out;
}

djpete_test::SyntheticDrive drive() {
    djpete_test::DriveOptions o;
    o.frames = kFrames;
    o.pointsPerMetre = 3;
    return djpete_test::makeDrive(o);
}

TEST(PureRubbish, leavesCamerasAloneAndMakesFewObjects) {
    const auto clean = drive();
    MapKeeper expected({}, Mode::Lockstep), keeper({}, Mode::Lockstep);
    Random random(11);
    for (const auto& f : clean.frames) {
        expected.addFrame(f.keyframe, nullptr);
        auto detections = obs::CObservationDetectedObjects::Create();
        detections->timestamp = f.keyframe->timestamp;
        detections->detections = rubbish(random);
        keeper.addFrame(f.keyframe, detections);
    }
    expected.finish();
    keeper.finish();
    keeper.map().check();
    EXPECT_EQ(cameraNumbers(keeper.map()).size(), 17 * kFrames);
    EXPECT_TRUE(sameBytes(cameraNumbers(expected.map()), cameraNumbers(keeper.map())));

    const auto& s = keeper.statistics();
    std::cout << kBoxes << " random boxes in each of " << kFrames << " frames: " << s.objectsCreated
              << " objects, " << keeper.map().objects().size() << " at the end\n";
    for (const auto& [stage, times] : s.stages) {
        std::cout << "  " << stage << " " << times.total_ms() << " ms, p95 " << times.p95_ms()
                  << "\n";
    }
    // One object for a thousand boxes would be too many.
    EXPECT_LT(s.objectsCreated, kBoxes * kFrames / 1000);
    // Each kind is said once, with how often.
    auto rejected = s.rejected;
    EXPECT_EQ(rejected[kBadPose], kFrames * kBoxes / 10);
    EXPECT_EQ(rejected[kBadSize], kFrames * kBoxes / 20);
    EXPECT_EQ(rejected[kBadInformation], kFrames * kBoxes / 20);
    std::vector<std::string> kinds;
    for (const auto& [why, count] : s.rejected) {
        kinds.push_back(why);
        EXPECT_GT(count, 0U) << why;
    }
    EXPECT_THAT(kinds,
                testing::IsSubsetOf(
                    {kBadPose, kBadSize, kBadInformation, "detection more than a frame may have",
                     "detection that doubles another one", "detection beyond the range"}));
}

TEST(PureRubbish, candidatesAndWhatTheyRememberStayBounded) {
    const AssociationOptions options;
    ObjectAssociator associator(options);
    BackendStatistics statistics;
    Random random(12);
    std::size_t things = 0, waiting = 0, early = 0;
    for (unsigned i = 0; i < kFrames; ++i) {
        obs::CObservationVisualKeyframe keyframe;
        keyframe.frame = {i};
        obs::CObservationDetectedObjects detections;
        detections.detections = rubbish(random);
        ObjectAssociator::Frame frame;
        frame.frame = {i};
        frame.time_s = 0.1 * i;
        for (const auto key : associator.associate(
                 frame, goodDetections(keyframe, detections, options, statistics))) {
            auto& thing = associator.thing(key);
            if (!thing.object && associator.confirmed(thing)) thing.object = map::ObjectId{key};
            if (thing.object) thing.waiting.clear();
        }
        std::size_t remembered = 0;
        for (const auto& [key, thing] : associator.things()) {
            EXPECT_TRUE(thing.filter.p_world().allFinite());
            EXPECT_TRUE(thing.size_m.allFinite());
            remembered += thing.waiting.size();
        }
        things = std::max(things, associator.things().size());
        waiting = std::max(waiting, remembered);
        if (i == 20) early = things;
    }
    std::cout << "at most " << things << " things with " << waiting << " observations; " << early
              << " things after 20 frames\n";
    // What is seen once lives for maxMisses frames more: it does not pile up.
    EXPECT_LE(things, options.maxDetections * (options.maxMisses + 2));
    EXPECT_LE(waiting, 3 * options.maxDetections * (options.maxMisses + 2));
    EXPECT_LT(things, early + early / 4);
}

TEST(PureRubbish, nothingButBrokenBoxesIsLikeNoBoxes) {
    const auto clean = drive();
    MapKeeper expected({}, Mode::Lockstep), keeper({}, Mode::Lockstep);
    for (std::size_t i = 0; i < 30; ++i) {
        const auto& f = clean.frames[i];
        expected.addFrame(f.keyframe, nullptr);
        auto detections = obs::CObservationDetectedObjects::Create();
        obs::ObjectDetection d;
        d.size_m.setZero();
        detections->detections.assign(kBoxes, d);
        keeper.addFrame(f.keyframe, detections);
    }
    expected.finish();
    keeper.finish();
    EXPECT_TRUE(keeper.map().objects().empty());
    EXPECT_EQ(keeper.statistics().rejected.size(), 1U);
    EXPECT_EQ(keeper.statistics().rejected.at(kBadSize), 30U * kBoxes);
    EXPECT_TRUE(
        sameBytes(djpete_test::mapNumbers(expected.map()), djpete_test::mapNumbers(keeper.map())));
}

}  // namespace
}  // namespace djpete::backend
