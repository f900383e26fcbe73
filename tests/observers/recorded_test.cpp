/// RecordedObserver finds what was recorded for a stamp, and nothing else.
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include "djpete/obs/errors.h"
#include "djpete/observers/recorded_observer.h"
#include "djpete_test/shared_data.h"

namespace {

using namespace djpete;
using observers::RecordedObserver;

obs::CObservationDetectedObjects::Ptr entry(double stamp_s, int count, double sensorX = 0) {
    auto o = obs::CObservationDetectedObjects::Create();
    o->timestamp = mrpt::Clock::fromDouble(stamp_s);
    o->sensorPose.x(sensorX);
    for (int i = 0; i < count; ++i) {
        obs::ObjectDetection d;
        d.score = static_cast<float>(stamp_s) + static_cast<float>(i);
        d.size_m = {4, 1.7, 1.5};
        o->detections.push_back(d);
    }
    return o;
}

std::filesystem::path write(const std::string& name,
                            const std::vector<obs::CObservationDetectedObjects::Ptr>& entries) {
    const auto file = djpete_test::scratch("recorded_" + name) / "drive_objects.rawlog";
    mrpt::io::CFileGZOutputStream out(file.string());
    auto archive = mrpt::serialization::archiveFrom(out);
    for (const auto& e : entries) archive << *e;
    return file;
}

obs::SensorFrame frameAt(double stamp_s) {
    obs::SensorFrame f;
    f.stamp = mrpt::Clock::fromDouble(stamp_s);
    return f;
}

TEST(RecordedObserver, FindsTheEntryOfTheStampWithinAMillisecond) {
    RecordedObserver observer(write("stamps", {entry(100, 1), entry(100.1, 2), entry(100.2, 0)}));
    EXPECT_EQ(observer.size(), 3U);
    const auto exact = observer.observe(frameAt(100.1), nullptr, nullptr);
    ASSERT_TRUE(exact);
    EXPECT_EQ(exact->detections.size(), 2U);
    const auto close = observer.observe(frameAt(100.0009), nullptr, nullptr);
    ASSERT_TRUE(close);
    EXPECT_EQ(close->detections.size(), 1U);
    EXPECT_EQ(close->timestamp, mrpt::Clock::fromDouble(100.0009));
    EXPECT_FALSE(observer.observe(frameAt(100.0012), nullptr, nullptr));
    EXPECT_FALSE(observer.observe(frameAt(99.9988), nullptr, nullptr));
    const auto seenEmpty = observer.observe(frameAt(100.2), nullptr, nullptr);
    ASSERT_TRUE(seenEmpty) << "an entry without objects is not the same as no entry";
    EXPECT_TRUE(seenEmpty->detections.empty());
}

TEST(RecordedObserver, PrefersTheNearerOfTwoCloseStamps) {
    RecordedObserver observer(write("close", {entry(100, 1), entry(100.0006, 2)}));
    EXPECT_EQ(observer.observe(frameAt(100.0001), nullptr, nullptr)->detections.size(), 1U);
    EXPECT_EQ(observer.observe(frameAt(100.0005), nullptr, nullptr)->detections.size(), 2U);
}

TEST(RecordedObserver, JoinsEntriesOfOneStamp) {
    RecordedObserver observer(write("joined", {entry(100, 1), entry(100, 2)}));
    EXPECT_EQ(observer.observe(frameAt(100), nullptr, nullptr)->detections.size(), 3U);
    EXPECT_THROW(RecordedObserver(write("poses", {entry(100, 1), entry(100, 2, 0.5)})),
                 obs::InputError);
}

TEST(RecordedObserver, UsesTheFramesOwnDetectionsWithoutAFile) {
    RecordedObserver observer;
    auto frame = frameAt(100);
    EXPECT_FALSE(observer.observe(frame, nullptr, nullptr));
    frame.detections = {entry(100, 1), entry(100, 1)};
    EXPECT_EQ(observer.observe(frame, nullptr, nullptr)->detections.size(), 2U);
    EXPECT_EQ(frame.detections.front()->detections.size(), 1U) << "the frame must stay as it was";
}

TEST(RecordedObserver, RefusesAMissingFile) {
    EXPECT_THROW(RecordedObserver("/nowhere/x_objects.rawlog"), obs::InputError);
}

}  // namespace
