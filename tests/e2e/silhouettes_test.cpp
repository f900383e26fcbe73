/// djpete-eval --silhouettes on a simulated drive with its own masks, and on a real one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "detect_objects_app.h"
#include "djpete/evaluation/image_files.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete_eval_app.h"
#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

using testing::HasSubstr;

/// What the program prints; its sentence if it fails.
std::string evaluate(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"djpete-eval"};
    for (const auto& a : arguments) argv.push_back(a.c_str());
    try {
        djpete::apps::DjpeteEvalApp app;
        if (!app.initialize(int(argv.size()), argv.data())) return "";
        std::ostringstream out;
        app.run(out);
        return out.str();
    } catch (const djpete::obs::InputError& e) {
        return std::string("refused: ") + e.what();
    }
}

nlohmann::json silhouettes(const fs::path& result, const fs::path& detections,
                           const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"--silhouettes", result.string(), "--drive", detections.string(),
                                   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto text = evaluate(words);
    const auto out = nlohmann::json::parse(text, nullptr, false);
    EXPECT_FALSE(out.is_discarded()) << text;
    return out;
}

/// The true instances of the simulated drive as detections with masks.
void writeMasks(const fs::path& rawlog, const fs::path& drive, const fs::path& file,
                const std::string& source) {
    using namespace djpete;
    mrpt::io::CFileGZOutputStream stream(file.string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    obs::RawlogSource frames(rawlog);
    while (const auto frame = frames.next()) {
        char name[32];
        std::snprintf(name, sizeof(name), "%06d.png", int(frame->id.value));
        const auto instances = evaluation::readInstances((drive / "instances" / name).string());
        auto seen = obs::CObservationDetectedObjects::Create();
        seen->timestamp = frame->stamp;
        seen->sensorLabel = obs::label::kDetections;
        const std::set<uint16_t> values(instances.pixels.begin(), instances.pixels.end());
        for (const uint16_t value : values) {
            if (value < 1000 || value >= 3000) continue;
            const auto mask = evaluation::maskOf(instances, value % 1000);
            obs::ObjectDetection d;
            d.objectClass = value < 2000 ? obs::ObjectClass::Car : obs::ObjectClass::Pedestrian;
            d.mask = obs::RleMask::fromDense(mask.pixels.data(), uint32_t(mask.width_px),
                                             uint32_t(mask.height_px), std::size_t(mask.width_px));
            d.source = source;
            seen->detections.push_back(d);
        }
        archive << *seen;
    }
}

class SimulatedSilhouettes : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new fs::path(scratch("silhouettes"));
        ASSERT_EQ(simulate({"--out", (*folder_ / "d").string(), "--frames", "0:40", "--seed", "3",
                            "--size", "620x188"})
                      .code,
                  0);
        const auto converted =
            convert({"--input", (*folder_ / "d").string(), "--out", rawlog().string()});
        ASSERT_EQ(converted.code, 0) << converted.sentence;
        djpete::apps::DjpeteSlamApp app;
        const auto outcome = slam(app, {rawlog().string(), "--out", result().string()});
        ASSERT_EQ(outcome.code, 0) << outcome.sentence;
        writeMasks(rawlog(), *folder_ / "d", masks(), "true");
    }
    static void TearDownTestSuite() { delete folder_; }
    static fs::path rawlog() { return *folder_ / "sim.rawlog"; }
    static fs::path result() { return *folder_ / "result"; }
    static fs::path masks() { return *folder_ / "sim_masks.rawlog"; }
    static fs::path* folder_;
};
fs::path* SimulatedSilhouettes::folder_ = nullptr;

TEST_F(SimulatedSilhouettes, modelsFitTheTrueMasksAndWorseWithWrongPoses) {
    const auto strips = *folder_ / "strips";
    const auto found = silhouettes(result(), masks(), {"--strips", strips.string()});
    EXPECT_GE(found["objects_with_masks"], 2) << found.dump(2);
    EXPECT_GE(found["silhouette_iou_median"], 0.75) << found.dump(2);
    EXPECT_EQ(found["frames_with_boxes"], 0);
    EXPECT_EQ(found["frames_with_masks"].get<int>() + found["keyframes"].get<int>(), 40);
    EXPECT_TRUE(found["box_iou_median"].is_null());  // never mixed
    for (const auto& object : found["per_object"]) {
        char name[32];
        std::snprintf(name, sizeof(name), "%04d.png", object["object"].get<int>());
        EXPECT_GT(fs::file_size(strips / name), 1000U);
    }
    const auto wrong = silhouettes(result(), masks(), {"--disturb", "0.6,10"});
    EXPECT_LT(wrong["silhouette_iou_median"].get<double>(),
              found["silhouette_iou_median"].get<double>() - 0.05);
}

TEST_F(SimulatedSilhouettes, boxesAreAFigureOfTheirOwn) {
    const auto found = silhouettes(result(), *folder_ / "sim_objects.rawlog");
    EXPECT_GE(found["objects_with_boxes"], 2) << found.dump(2);
    EXPECT_GE(found["box_iou_median"], 0.6) << found.dump(2);
    EXPECT_TRUE(found["silhouette_iou_median"].is_null());
    EXPECT_EQ(found["frames_with_masks"], 0);
}

TEST_F(SimulatedSilhouettes, badInputGetsOneSentence) {
    const auto refused = [](const fs::path& result, const fs::path& detections,
                            const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"--silhouettes", result.string(), "--drive",
                                       detections.string()};
        words.insert(words.end(), more.begin(), more.end());
        const auto out = evaluate(words);
        EXPECT_THAT(out, testing::StartsWith("refused: "));
        EXPECT_THAT(out, testing::Not(HasSubstr("\n")));
        return out;
    };
    const auto bare = *folder_ / "bare";
    fs::create_directories(bare);
    for (const auto& entry : fs::directory_iterator(result())) {
        if (entry.is_regular_file()) {
            fs::copy_file(entry, bare / entry.path().filename(),
                          fs::copy_options::overwrite_existing);
        }
    }
    EXPECT_THAT(refused(bare, masks()), HasSubstr("bare/objects: no .object file"));
    EXPECT_THAT(refused("/nowhere", masks()), HasSubstr("/nowhere/objects.csv"));
    EXPECT_THAT(refused(result(), "/nowhere.rawlog"), HasSubstr("/nowhere.rawlog"));
    EXPECT_THAT(refused(result(), rawlog()), HasSubstr("sim.rawlog: no mask and no box"));
    const auto own = *folder_ / "own_masks.rawlog";
    writeMasks(rawlog(), *folder_ / "d", own, "geometric");
    EXPECT_THAT(refused(result(), own, {"--rawlog", rawlog().string()}),
                HasSubstr("the GeometricObserver's come from the scans"));
    EXPECT_THAT(evaluate({"--silhouettes", "r"}), HasSubstr("--silhouettes needs --drive"));
    EXPECT_THAT(refused(result(), masks(), {"--truth", "t"}), HasSubstr("--silhouettes goes with"));
}

/// On the figures that docs/RESULTS.md states.
TEST(RealSilhouettes, Drive0005) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti");
    const auto folder = scratch("silhouettes_0005");
    const auto rawlog = folder / "0005.rawlog", result = folder / "result";
    const auto converted = convert(
        {"--input", (kitti / "raw/2011_09_26/2011_09_26_drive_0005_sync").string(), "--labels",
         (kitti / "tracking/training/label_02/0000.txt").string(), "--out", rawlog.string()});
    ASSERT_EQ(converted.code, 0) << converted.sentence;
    djpete::apps::DjpeteSlamApp app;
    const auto outcome = slam(app, {rawlog.string(), "--out", result.string()},
                              std::string(DJPETE_SOURCE_DIR) + "/datasets_cfg/kitti_raw.ini");
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    const auto boxes = silhouettes(result, folder / "0005_objects.rawlog");
    EXPECT_GE(boxes["objects_with_boxes"], 1) << boxes.dump(2);
    EXPECT_GE(boxes["box_iou_median"], 0.80) << boxes.dump(2);

    DJPETE_SHARED_OR_SKIP(network, "models/yolov8n-seg_320x1056.onnx");
    const std::string drive = rawlog.string(), file = network.string();
    const char* argv[] = {"detect-objects", drive.c_str(), "--observer",
                          "network",        "--network",   file.c_str()};
    djpete::detect_objects::DetectObjectsApp detector;
    ASSERT_TRUE(detector.initialize(6, argv));
    std::ostringstream out;
    detector.run(out);
    EXPECT_EQ(detector.report.observed, 25U);
    const auto masks = silhouettes(result, folder / "0005_masks.rawlog");
    EXPECT_EQ(masks["objects_with_masks"], boxes["objects_with_boxes"]) << masks.dump(2);
    EXPECT_EQ(masks["views_without_truth"], 0) << masks.dump(2);
    EXPECT_GE(masks["silhouette_iou_median"], 0.80) << masks.dump(2);
}

}  // namespace
}  // namespace djpete_test
