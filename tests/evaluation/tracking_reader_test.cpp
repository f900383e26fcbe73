#include "djpete/evaluation/tracking_reader.h"

#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

const std::string kVan = "3 7 Van 1 2 -1.79 296.5 161.7 455.25 292.3 2.0 1.8 4.4 -4.5 1.8 13.4 0.5";
const std::string kDontCare =
    "3 -1 DontCare -1 -1 -10 219 188 245 218 -1000 -1000 -1000 -10 -1 -1 -1";

class TrackingReader : public ::testing::Test {
  protected:
    std::string write(const std::string& text) { return writeText(dir_ / "0006.txt", text); }
    const std::filesystem::path dir_ = djpete_test::scratch("tracking_reader");
};

}  // namespace

TEST_F(TrackingReader, ReadsAllColumnsAndKeepsDontCareApart) {
    const auto s = readTrackingSequence(write(kDontCare + "\n" + kVan + "\n" + kDontCare + "\n"));
    EXPECT_EQ(s.name, "0006");
    ASSERT_EQ(s.boxes.size(), 1U);
    const TrackingBox& box = s.boxes[0];
    EXPECT_EQ(box.frame, 3U);
    EXPECT_EQ(box.trackId, 7);
    EXPECT_EQ(box.objectClass, djpete::obs::ObjectClass::Van);
    EXPECT_EQ(box.truncation, 1);
    EXPECT_EQ(box.occlusion, 2);
    EXPECT_EQ(box.image.left, 296.5);
    EXPECT_EQ(box.image.top, 161.7);
    EXPECT_EQ(box.image.right, 455.25);
    EXPECT_EQ(box.image.bottom, 292.3);
    EXPECT_EQ(box.size_m, Vec3(4.4, 1.8, 2.0));
    EXPECT_LT((box.T_cam_obj.matrix() - labelPose({-4.5, 1.8, 13.4}, 2, 0.5).matrix()).norm(),
              1e-12);
    EXPECT_FALSE(box.score.has_value());
    ASSERT_EQ(s.dontCare.size(), 2U) << "several areas of one frame are no double track";
    EXPECT_EQ(s.dontCare[0].frame, 3U);
    EXPECT_EQ(s.dontCare[0].image.right, 245);
}

TEST_F(TrackingReader, ReadsScoresAndTypesInAnyCase) {
    const auto s =
        readTrackingSequence(write("0 1 car 0 0 0 1 2 3 4 1.5 2 4 0 1.6 10 0 -0.25\n"
                                   "0 -1 dontcare -1 -1 -10 1 2 3 4 -1 -1 -1 -1 -1 -1 -1\n"));
    ASSERT_EQ(s.boxes.size(), 1U);
    EXPECT_EQ(s.boxes[0].objectClass, djpete::obs::ObjectClass::Car);
    EXPECT_EQ(s.boxes[0].score, -0.25);
    EXPECT_EQ(s.dontCare.size(), 1U);
}

TEST_F(TrackingReader, AnEmptyFileIsADriveWithoutBoxes) {
    EXPECT_TRUE(readTrackingSequence(write("")).boxes.empty());
}

TEST_F(TrackingReader, RefusesBadRowsNamingTheLine) {
    EXPECT_INPUT_ERROR(readTrackingSequence(dir_ / "none.txt"), "none.txt", "no such file");
    EXPECT_INPUT_ERROR(readTrackingSequence(write("1 2 Car\n")), "0006.txt:1", "17", "got 3");
    EXPECT_INPUT_ERROR(readTrackingSequence(write(kVan + "\n" + kVan + "\n")), "0006.txt:2",
                       "two boxes");
    EXPECT_INPUT_ERROR(readTrackingSequence(write(kVan + "\n4" + kVan.substr(1) + " 0.9\n")),
                       "0006.txt:2", "score in every row");
    EXPECT_INPUT_ERROR(readTrackingSequence(write("0 1 Car 0 0 0 1 nan 3 4 1.5 2 4 0 1.6 10 0\n")),
                       "0006.txt:1", "top", "nan");
    EXPECT_INPUT_ERROR(readTrackingSequence(write("0 1 Car x 0 0 1 2 3 4 1.5 2 4 0 1.6 10 0\n")),
                       "0006.txt:1", "truncation");
    EXPECT_INPUT_ERROR(
        readTrackingSequence(write("0 1 Car 0 0 0 1 2 3 4 1.5 2 4 0 1.6 10 0 high\n")),
        "0006.txt:1", "score", "high");
}
