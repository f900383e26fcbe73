/// The whole line on a small simulated drive: every promised file is there and means something.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "djpete_eval_app.h"
#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

using testing::HasSubstr;

fs::path rawlogOf(const fs::path& drive, const std::string& name,
                  const std::vector<std::string>& more) {
    const auto rawlog = scratch(name) / "drive.rawlog";
    std::vector<std::string> arguments{"--input", drive.string(), "--out", rawlog.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = convert(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.sentence;
    return rawlog;
}

TEST(Line, FromSimulatorToTexturedObjects) {
    const auto rawlog =
        rawlogOf(smallDrive(), "e2e_line",
                 {"--labels", "none", "--detections", (smallDrive() / "detections.txt").string()});
    const auto out = rawlog.parent_path() / "result";
    djpete::apps::DjpeteSlamApp app;
    const auto outcome = slam(app, {rawlog.string(), "--out", out.string()});
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;

    EXPECT_EQ(app.summary.frames, 12U);
    EXPECT_EQ(app.summary.tracked, 12U);
    EXPECT_GE(app.summary.objects, 3U);
    EXPECT_GE(app.summary.texturedObjects, 2U);
    EXPECT_GE(app.summary.keyframes, 3U);
    ASSERT_TRUE(app.summary.ateSe3_m);
    EXPECT_LT(*app.summary.ateSe3_m, 0.10);
    EXPECT_NEAR(app.summary.pathLength_m, 11 * 0.8, 0.3);
    EXPECT_NO_THROW(app.slam->map().check());

    for (const char* name : {"trajectory.tum", "trajectory.kitti.txt", "objects.csv", "map.graph",
                             "scene.3Dscene", "summary.json"}) {
        EXPECT_GT(fs::file_size(out / name), 100U) << name;
    }
    EXPECT_FALSE(fs::is_empty(out / "objects"));
    const auto summary = nlohmann::json::parse(textOf(out / "summary.json"));
    EXPECT_EQ(summary["frames"], 12);
    EXPECT_TRUE(summary["error"].is_null());
    EXPECT_TRUE(summary["timings_ms"].contains("front end"));

    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile((out / "scene.3Dscene").string()));
    EXPECT_TRUE(scene.getByName("objects"));
    EXPECT_TRUE(scene.getByName("trajectory"));
}

TEST(Line, EvaluatorReadsWhatSlamWrites) {
    const auto rawlog = rawlogOf(smallDrive(), "e2e_eval", {});  // labels as detections
    const auto out = rawlog.parent_path() / "result";
    djpete::apps::DjpeteSlamApp app;
    ASSERT_EQ(slam(app, {rawlog.string(), "--out", out.string()}).code, 0);
    const std::string trajectory = (out / "trajectory.kitti.txt").string(),
                      truth = (smallDrive() / "poses.txt").string(),
                      objects = (out / "objects.csv").string(),
                      labels = (smallDrive() / "label_02.txt").string();
    const char* argv[] = {"djpete-eval",   "--trajectory", trajectory.c_str(),
                          "--truth",       truth.c_str(),  "--objects",
                          objects.c_str(), "--labels",     labels.c_str(),
                          "--max-range",   "30",           "--json"};
    djpete::apps::DjpeteEvalApp eval;
    ASSERT_TRUE(eval.initialize(12, argv));
    std::ostringstream text;
    eval.run(text);
    const auto json = nlohmann::json::parse(text.str());
    EXPECT_EQ(json["frames"], 12);
    EXPECT_LT(json["ate_se3_m"].get<double>(), 0.10);
    EXPECT_GE(json["objects_labelled"].get<int>(), 2);
    EXPECT_EQ(json["objects_matched_one_to_one"], json["objects_labelled"]);
    EXPECT_EQ(json["objects_duplicated"], 0);
    EXPECT_LT(json["centre_error_median_m"].get<double>(), 0.20);
}

TEST(Line, GeometricObserverNeedsNoDetections) {
    const auto rawlog = rawlogOf(smallDrive(), "e2e_geometric", {"--labels", "none"});
    fs::remove(rawlog.parent_path() / "drive_objects.rawlog");
    djpete::apps::DjpeteSlamApp app;
    const auto outcome =
        slam(app, {rawlog.string(), "--out", (rawlog.parent_path() / "result").string()});
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    EXPECT_GE(app.summary.objects, 2U);
}

TEST(Line, DriveWithoutImagesRunsOnPosesAndDetections) {
    const auto drive = copyOfSmallDrive("e2e_no_images");
    for (const char* name : {"image_0", "image_1", "image_2", "image_3", "velodyne", "instances"}) {
        fs::remove_all(drive / name);
    }
    const auto rawlog =
        rawlogOf(drive, "e2e_no_images_log",
                 {"--labels", "none", "--detections", (drive / "detections.txt").string()});
    djpete::apps::DjpeteSlamApp app;
    const auto outcome =
        slam(app, {rawlog.string(), "--out", (rawlog.parent_path() / "result").string()});
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    EXPECT_EQ(app.summary.frames, 12U);
    EXPECT_GE(app.summary.objects, 3U);
    EXPECT_LT(*app.summary.ateSe3_m, 1e-6);
}

TEST(Line, RangeRunsThoseFramesOnly) {
    const auto rawlog = rawlogOf(smallDrive(), "e2e_range", {"--labels", "none"});
    djpete::apps::DjpeteSlamApp app;
    ASSERT_EQ(slam(app, {rawlog.string(), "--range", "2:6", "--observer", "none", "--out",
                         (rawlog.parent_path() / "result").string()})
                  .code,
              0);
    EXPECT_EQ(app.summary.frames, 4U);
    EXPECT_EQ(app.slam->map().frames().begin()->first.value, 2U);
}

}  // namespace
}  // namespace djpete_test
