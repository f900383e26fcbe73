#include "djpete/evaluation/label_reader.h"

#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

const std::string kVan =
    "3 7 Van 0 0 -1.79 296.7 161.7 455.2 292.3 2.0 1.8 4.4 -4.5 1.8 13.4 0.0\n";

class LabelReader : public ::testing::Test {
  protected:
    std::string write(const std::string& text) { return writeText(dir_ / "l.txt", text); }
    const std::filesystem::path dir_ = djpete_test::scratch("label_reader");
};

}  // namespace

TEST_F(LabelReader, ReadsBoxesAndLeavesOutDontCare) {
    const auto boxes = readTrackingLabels(
        write("0 -1 DontCare -1 -1 -10 219 188 245 218 -1000 -1000 -1000 -10 -1 -1 -1\n" + kVan));
    ASSERT_EQ(boxes.size(), 1U);
    EXPECT_EQ(boxes[0].frame, 3U);
    EXPECT_EQ(boxes[0].trackId, 7);
    EXPECT_EQ(boxes[0].objectClass, djpete::obs::ObjectClass::Van);
    EXPECT_EQ(boxes[0].size_m, Vec3(4.4, 1.8, 2.0));
    EXPECT_LT((boxes[0].T_cam_obj.translation() - Vec3(-4.5, 0.8, 13.4)).norm(), 1e-12);
}

TEST_F(LabelReader, ReadsAScoreColumn) {
    const std::string scored = kVan.substr(0, kVan.size() - 1) + " 0.9\n";
    EXPECT_EQ(readTrackingLabels(write(scored)).size(), 1U);
}

TEST_F(LabelReader, AxesOfTheObjectInTheCamera) {
    const Mat3 ahead = labelPose(Vec3::Zero(), 0, 0).rotation();
    EXPECT_LT((ahead.col(0) - Vec3(1, 0, 0)).norm(), 1e-12) << "length to the camera's right";
    EXPECT_LT((ahead.col(1) - Vec3(0, 0, 1)).norm(), 1e-12) << "left is away from the camera";
    EXPECT_LT((ahead.col(2) - Vec3(0, -1, 0)).norm(), 1e-12) << "up is against the camera's y";
    // KITTI: a car that drives as the camera does has rotation_y = -pi/2.
    const Mat3 same = labelPose(Vec3::Zero(), 0, -M_PI / 2).rotation();
    EXPECT_LT((same.col(0) - Vec3(0, 0, 1)).norm(), 1e-12);
    EXPECT_NEAR(same.determinant(), 1, 1e-12);
}

TEST_F(LabelReader, RefusesBadRowsNamingTheLine) {
    EXPECT_INPUT_ERROR(readTrackingLabels(dir_ / "none.txt"), "none.txt", "no such file");
    EXPECT_INPUT_ERROR(readTrackingLabels(write("")), "empty");
    EXPECT_INPUT_ERROR(readTrackingLabels(write(kVan + "4 7 Van 0 0 1 2 3\n")), "l.txt:2", "17",
                       "got 8");
    EXPECT_INPUT_ERROR(
        readTrackingLabels(write("3 7 Van 0 0 0 0 0 9 9 2.0 1.8 4.4 nan 1.8 13.4 0.0\n")),
        "l.txt:1", "x", "nan");
    EXPECT_INPUT_ERROR(
        readTrackingLabels(write("3 7 Van 0 0 0 0 0 9 9 0 1.8 4.4 1 1.8 13.4 0.0\n")), "l.txt:1",
        "above 0");
    EXPECT_INPUT_ERROR(
        readTrackingLabels(write("-3 7 Van 0 0 0 0 0 9 9 2 1.8 4.4 1 1.8 13.4 0.0\n")), "l.txt:1",
        "frame");
    EXPECT_INPUT_ERROR(readTrackingLabels(write(kVan + kVan)), "l.txt:2", "track 7", "frame 3");
}
