/// kitti2rawlog on small made-up drives.
#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "made_up_drive.h"

namespace fs = std::filesystem;
using djpete::obs::RawlogSource;
using made_up::frameName;
using made_up::framesOf;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string label(int frame, int track, const std::string& type = "Car") {
    return std::to_string(frame) + " " + std::to_string(track) + " " + type +
           " 0 0 0 4 4 12 12 1.5 1.6 4 0 1 10 -1.57\n";
}

}  // namespace

TEST(Kitti2Rawlog, StereoScansAndPosesOfTheOdometryLayout) {
    const auto dir = made_up::drive("k2r_odometry");
    const auto out = dir / "d.rawlog";
    const auto report = made_up::run({"--input", dir.string(), "--out", out.string()});
    EXPECT_EQ(report.stereoPairs, 4U);
    EXPECT_EQ(report.scans, 2U);
    EXPECT_THAT(report.files, ElementsAre(out));
    RawlogSource source(out);
    EXPECT_EQ(source.info().name, "kitti odometry 77");
    ASSERT_TRUE(source.info().gray);
    EXPECT_EQ(source.info().gray->model.baseline_m, 0.5);
    EXPECT_FALSE(source.info().color);
    for (uint64_t i = 0; i < 4; ++i) {
        const auto f = source.next();
        ASSERT_TRUE(f);
        EXPECT_EQ(f->id.value, i);
        EXPECT_EQ(f->hasScan(), i % 2 == 0);
        const auto images = f->loadMainImages();
        ASSERT_TRUE(images && images->right);
        EXPECT_EQ(images->left.getWidth(), 32U);
        // One metre along the camera's z is one along the vehicle's x.
        ASSERT_TRUE(f->T_world_vehicle_truth);
        EXPECT_NEAR(f->T_world_vehicle_truth->translation().x(), static_cast<double>(i), 1e-12);
        EXPECT_NEAR(f->T_world_vehicle_truth->translation().y(), 0, 1e-12);
        EXPECT_NEAR(f->T_world_vehicle_truth->angle_rad(), 0, 1e-9);
    }
    EXPECT_FALSE(source.next());
}

TEST(Kitti2Rawlog, AnyKindOfGapIsNormal) {
    const auto dir = made_up::drive("k2r_gaps", 8);
    fs::remove(dir / "image_1" / "000001.png");  // one left image alone
    fs::remove(dir / "image_0" / "000002.png");  // one right image alone, but a scan
    for (int i : {3, 5})
        for (const char* cam : {"image_0", "image_1"})
            fs::remove(dir / cam / (frameName(i) + ".png"));
    const auto report =
        made_up::run({"--input", dir.string(), "--out", (dir / "d.rawlog").string()});
    EXPECT_EQ(report.singleImages, 1U);
    EXPECT_EQ(report.rightOnly, 1U);
    EXPECT_THAT(report.info.missing, ElementsAre(3, 5));
    std::vector<uint64_t> ids;
    for (const auto& f : framesOf(dir / "d.rawlog")) ids.push_back(f.id.value);
    EXPECT_THAT(ids, ElementsAre(0, 1, 2, 4, 6, 7));
    EXPECT_TRUE(framesOf(dir / "d.rawlog")[1].imageGray);
}

TEST(Kitti2Rawlog, ARangeKeepsKittisFrameNumbers) {
    const auto dir = made_up::drive("k2r_range", 6);
    made_up::run({"--input", dir.string(), "--out", (dir / "d.rawlog").string(), "--range", "2:4"});
    const auto frames = framesOf(dir / "d.rawlog");
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].id.value, 2U);
    EXPECT_NEAR(frames[0].T_world_vehicle_truth->translation().x(), 2, 1e-12)
        << "world is the vehicle at row 0 of the poses";
}

TEST(Kitti2Rawlog, CopiedFilesMakeTheRawlogMovable) {
    const auto dir = made_up::drive("k2r_copy");
    const auto out = dir.parent_path() / "d.rawlog";
    made_up::run({"--input", dir.string(), "--out", out.string(), "--copy"});
    fs::remove_all(dir);
    const auto moved = djpete_test::scratch("k2r_copy_moved");
    fs::rename(out, moved / "d.rawlog");
    fs::rename(dir.parent_path() / "d_Images", moved / "d_Images");
    for (const auto& f : framesOf(moved / "d.rawlog")) {
        EXPECT_TRUE(f.loadMainImages());
        EXPECT_EQ(f.loadScan().has_value(), f.id.value % 2 == 0);
    }
}

TEST(Kitti2Rawlog, TheSameInputGivesTheSameBytes) {
    const auto dir = made_up::drive("k2r_bytes");
    made_up::writeText(dir / "label_02.txt", label(0, 1) + label(2, 1));
    for (const char* name : {"a", "b"})
        made_up::run({"--input", dir.string(), "--out", (dir / name / "d.rawlog").string()});
    EXPECT_EQ(bytesOf(dir / "a" / "d.rawlog"), bytesOf(dir / "b" / "d.rawlog"));
    EXPECT_EQ(bytesOf(dir / "a" / "d_objects.rawlog"), bytesOf(dir / "b" / "d_objects.rawlog"));
}

TEST(Kitti2Rawlog, LabelsBesideTheDriveBecomeObjectsWithMasks) {
    const auto dir = made_up::drive("k2r_labels");
    made_up::writeText(dir / "label_02.txt", label(1, 7) + label(1, 8, "Pedestrian"));
    cv::Mat ids(16, 32, CV_16UC1, cv::Scalar(0));
    ids(cv::Rect(4, 5, 6, 3)) = 1007;
    ids(cv::Rect(20, 5, 2, 2)) = 10000;  // ignored regions
    fs::create_directories(dir / "instances");
    ASSERT_TRUE(cv::imwrite((dir / "instances" / "000001.png").string(), ids));
    const auto report =
        made_up::run({"--input", dir.string(), "--out", (dir / "d.rawlog").string()});
    EXPECT_THAT(report.files, ElementsAre(dir / "d.rawlog", dir / "d_objects.rawlog"));
    EXPECT_EQ(report.labels, 2U);
    const auto objects = djpete::obs::readDetections(dir / "d_objects.rawlog");
    ASSERT_EQ(objects.size(), 4U) << "one entry per frame, empty where nothing is seen";
    EXPECT_TRUE(objects[0]->detections.empty());
    ASSERT_EQ(objects[1]->detections.size(), 2U);
    const auto& car = objects[1]->detections[0];
    EXPECT_EQ(car.sourceTrackId, 7);
    EXPECT_EQ(car.source, "label_02");
    ASSERT_TRUE(car.mask);
    EXPECT_EQ(car.mask->area_px(), 18U);
    EXPECT_EQ(car.mask->toDense()[5 * 32 + 4], 255);
    EXPECT_FALSE(objects[1]->detections[1].mask);
    EXPECT_EQ(objects[1]->timestamp, framesOf(dir / "d.rawlog")[1].stamp);
    EXPECT_NEAR(objects[1]->sensorPose.x(), 0.3, 1e-12) << "camera 0 on the vehicle";
    // Camera 2 sees what is 10 m away 0.1 px further right than camera 0, and only that is there.
    ASSERT_TRUE(car.box);
    EXPECT_NEAR(car.box->left, 4 - 0.1, 1e-5);
}

TEST(Kitti2Rawlog, DetectionsComeBeforeLabels) {
    const auto dir = made_up::drive("k2r_both");
    made_up::writeText(dir / "label_02.txt", label(0, 7));
    made_up::writeText(dir / "detections.txt", label(0, -1) + label(1, -1));
    const auto report =
        made_up::run({"--input", dir.string(), "--out", (dir / "d.rawlog").string()});
    EXPECT_THAT(report.files,
                ElementsAre(dir / "d.rawlog", dir / "d_objects.rawlog", dir / "d_labels.rawlog"));
    const auto d = djpete::obs::readDetections(dir / "d_objects.rawlog")[0]->detections.at(0);
    EXPECT_EQ(d.source, "detections");
    EXPECT_FALSE(d.sourceTrackId);
    EXPECT_NEAR(d.information(0, 0), 1 / 0.09, 1e-9);
    const auto l = djpete::obs::readDetections(dir / "d_labels.rawlog")[0]->detections.at(0);
    EXPECT_NEAR(l.information(0, 0), 1 / 0.01, 1e-9);
    const auto none = made_up::run({"--input", dir.string(), "--out", (dir / "n.rawlog").string(),
                                    "--labels", "none", "--detections", "none"});
    EXPECT_THAT(none.files, ElementsAre(dir / "n.rawlog"));
}

TEST(Kitti2Rawlog, ADriveWithoutImagesNeedsOnlyPosesAndDetections) {
    const auto dir = made_up::drive("k2r_no_images");
    for (const char* f : {"image_0", "image_1", "velodyne"}) fs::remove_all(dir / f);
    made_up::writeText(dir / "detections.txt", label(3, 1));
    made_up::run({"--input", dir.string(), "--out", (dir / "d.rawlog").string()});
    const auto frames = framesOf(dir / "d.rawlog");
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_TRUE(frames[3].T_world_vehicle_truth);
    EXPECT_FALSE(frames[3].hasImages());
    RawlogSource companion(dir / "d_objects.rawlog");
    EXPECT_EQ(companion.info().mainCamera("x").model.baseline_m, 0.5);
    EXPECT_EQ(djpete::obs::readDetections(dir / "d_objects.rawlog").at(3)->detections.size(), 1U);
}

TEST(Kitti2Rawlog, HelpIsNoError) {
    const char* argv[] = {"kitti2rawlog", "--help"};
    testing::internal::CaptureStdout();
    djpete::kitti2rawlog::Kitti2RawlogApp app;
    EXPECT_FALSE(app.initialize(2, argv));
    EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("--detections"));
}
