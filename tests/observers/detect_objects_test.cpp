/// detect-objects from command line to companion rawlog.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <sstream>

#include "detect_objects_app.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete_test/shared_data.h"
#include "synthetic_scan.h"

namespace {

using namespace djpete;
using detect_objects::DetectObjectsApp;
using testing::HasSubstr;

double stampOf(int frame) { return 1000 + 0.1 * frame; }

mrpt::obs::CObservationPointCloud::Ptr observationOf(const obs::LidarScan& scan, double stamp_s) {
    auto cloud = mrpt::maps::CPointsMapXYZI::Create();
    for (const auto& p : scan.points) cloud->insertPointFast(p.x, p.y, p.z);
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->pointcloud = cloud;
    o->timestamp = mrpt::Clock::fromDouble(stamp_s);
    o->sensorLabel = obs::label::kVelodyne;
    return o;
}

/// A drive of three frames with one car each, the camera in its head.
std::filesystem::path writeDrive(const std::string& name) {
    const auto file = djpete_test::scratch("detect_objects_" + name) / "drive.rawlog";
    mrpt::io::CFileGZOutputStream out(file.string());
    auto archive = mrpt::serialization::archiveFrom(out);
    obs::DriveInfo info;
    info.name = "synthetic";
    info.frameCount = 3;
    info.gray = djpete_test::forwardCamera();
    mrpt::obs::CObservationComment head;
    head.sensorLabel = obs::label::kCalibration;
    head.timestamp = mrpt::Clock::fromDouble(stampOf(0));
    head.text = obs::toIniText(info);
    archive << head;
    for (int frame = 0; frame < 3; ++frame) {
        djpete_test::SyntheticStreet street;
        street.addCar(14.0 - frame, 3, 0);
        archive << *observationOf(street.scan(), stampOf(frame));
    }
    return file;
}

DetectObjectsApp initialized(std::vector<std::string> words) {
    words.insert(words.begin(), "detect-objects");
    std::vector<const char*> argv;
    for (const auto& w : words) argv.push_back(w.c_str());
    DetectObjectsApp app;
    EXPECT_TRUE(app.initialize(static_cast<int>(argv.size()), argv.data()));
    return app;
}

std::string sentenceOf(const std::vector<std::string>& words) {
    try {
        auto app = initialized(words);
        std::ostringstream out;
        app.run(out);
    } catch (const obs::InputError& e) {
        return e.what();
    }
    return "no error";
}

TEST(DetectObjects, WritesOneEntryPerFrame) {
    const auto drive = writeDrive("entries");
    auto app = initialized({drive.string()});
    std::ostringstream out;
    app.run(out);
    EXPECT_EQ(app.report.frames, 3U);
    EXPECT_EQ(app.report.observed, 3U);
    EXPECT_EQ(app.report.detections, 3U);
    EXPECT_THAT(out.str(), HasSubstr("3 objects in 3 of 3 frames"));
    const auto entries = obs::readDetections(drive.parent_path() / "drive_objects.rawlog");
    ASSERT_EQ(entries.size(), 3U);
    for (int i = 0; i < 3; ++i) {
        const auto& e = *entries[static_cast<std::size_t>(i)];
        EXPECT_EQ(e.timestamp, mrpt::Clock::fromDouble(stampOf(i)));
        EXPECT_EQ(e.sensorLabel, obs::label::kDetections);
        ASSERT_EQ(e.detections.size(), 1U);
        EXPECT_NEAR(e.detections[0].T_sensor_obj.translation().x(), 14 - i, 0.5);
        EXPECT_EQ(e.detections[0].source, "geometric");
        EXPECT_TRUE(e.detections[0].mask) << "the head names the camera";
    }
}

TEST(DetectObjects, TakesRangeAndOutAndConfig) {
    const auto drive = writeDrive("range");
    const auto ini = drive.parent_path() / "tuning.ini";
    std::ofstream(ini) << "[geometric_observer]\nrange_max_m = 10\n";
    const auto target = drive.parent_path() / "sub" / "o.rawlog";
    auto app = initialized(
        {drive.string(), "--range", "1:2", "--out", target.string(), "--config", ini.string()});
    EXPECT_EQ(app.job.geometric.rangeMax_m, 10);
    std::ostringstream out;
    app.run(out);
    EXPECT_EQ(app.report.frames, 1U);
    EXPECT_EQ(app.report.detections, 0U) << "the car is farther than 10 m";
    const auto entries = obs::readDetections(target);
    ASSERT_EQ(entries.size(), 1U);
    EXPECT_EQ(entries[0]->timestamp, mrpt::Clock::fromDouble(stampOf(1)));
}

TEST(DetectObjects, CopiesRecordedDetections) {
    const auto drive = writeDrive("recorded");
    auto first = initialized({drive.string()});
    std::ostringstream out;
    first.run(out);
    const auto objects = drive.parent_path() / "drive_objects.rawlog";
    const auto copy = drive.parent_path() / "copy.rawlog";
    auto second = initialized({drive.string(), "--observer", "recorded", "--from", objects.string(),
                               "--out", copy.string()});
    second.run(out);
    EXPECT_EQ(second.report.detections, 3U);
    EXPECT_EQ(obs::readDetections(copy).size(), 3U);
}

TEST(DetectObjects, RepeatsByteForByte) {
    const auto drive = writeDrive("bytes");
    std::vector<std::string> contents;
    for (const char* name : {"a.rawlog", "b.rawlog"}) {
        const auto file = drive.parent_path() / name;
        auto app = initialized({drive.string(), "--out", file.string()});
        std::ostringstream out;
        app.run(out);
        std::ifstream in(file, std::ios::binary);
        contents.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    EXPECT_FALSE(contents[0].empty());
    EXPECT_EQ(contents[0], contents[1]);
}

TEST(DetectObjects, KeepsWhatItWroteBeforeADamagedPlace) {
    const auto drive = writeDrive("damaged");
    std::filesystem::resize_file(drive, std::filesystem::file_size(drive) * 3 / 4);
    const auto sentence = sentenceOf({drive.string()});
    EXPECT_THAT(sentence, HasSubstr("drive.rawlog"));
    EXPECT_NE(sentence, "no error");
    EXPECT_GE(obs::readDetections(drive.parent_path() / "drive_objects.rawlog").size(), 1U);
}

TEST(DetectObjects, TellsBadInputInOneSentence) {
    const auto drive = writeDrive("bad");
    const auto folder = drive.parent_path();
    EXPECT_THAT(sentenceOf({(folder / "none.rawlog").string()}), HasSubstr("none.rawlog"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none_objects.rawlog"));
    EXPECT_THAT(sentenceOf({drive.string(), "--observer", "psychic"}), HasSubstr("psychic"));
    EXPECT_THAT(sentenceOf({drive.string(), "--range", "5:2"}), HasSubstr("5:2"));
    EXPECT_THAT(sentenceOf({drive.string(), "--range", "50:60"}), HasSubstr("no frame"));
    EXPECT_THAT(sentenceOf({drive.string(), "--out", drive.string()}), HasSubstr("overwrite"));
    EXPECT_THAT(sentenceOf({drive.string(), "--out", folder.string()}), HasSubstr("written"));
    EXPECT_THAT(sentenceOf({drive.string(), "--config", "/nowhere.ini"}), HasSubstr("nowhere.ini"));
    EXPECT_THAT(sentenceOf({drive.string(), "--frobnicate"}), HasSubstr("--help"));
    const auto ini = folder / "bad.ini";
    std::ofstream(ini) << "[geometric_observer]\nrange_max = 10\n";
    const auto sentence = sentenceOf({drive.string(), "--config", ini.string()});
    EXPECT_THAT(sentence, HasSubstr("range_max"));
    EXPECT_THAT(sentence, HasSubstr("bad.ini"));
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
    EXPECT_EQ(sentenceOf({}).find('\n'), std::string::npos);
}

}  // namespace
