#include "djpete/evaluation/objects_csv.h"

#include <algorithm>

#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

const SE3 kFirstCam = SE3::exp((Vec6() << 0.3, 0, -0.1, 1.2, -1.2, 1.2).finished());

class ObjectsCsv : public ::testing::Test {
  protected:
    std::string write(const std::string& text) { return writeText(dir_ / "o.csv", text); }
    /// A good file with one row whose field (from 0) is replaced.
    std::string withField(std::size_t field, const std::string& value) {
        std::istringstream row(csvRow(4, "Car", 11, SE3()));
        std::string text, word;
        for (std::size_t i = 0; std::getline(row, word, ','); ++i) {
            text += (i ? "," : "") + (i == field ? value : word);
        }
        return write(csvPreamble(5, kFirstCam) + text);
    }
    const std::filesystem::path dir_ = djpete_test::scratch("objects_csv");
};

}  // namespace

TEST_F(ObjectsCsv, ReadsEveryColumn) {
    const SE3 T = SE3::fromYaw(0.4, {10, -3, 0.5});
    const auto file =
        readObjectsCsv(write(csvPreamble(5, kFirstCam) + csvRow(4, "Van", 11, T, {1, 2, 3}, true)));
    EXPECT_EQ(file.firstFrame, 5U);
    EXPECT_LT((file.T_world_firstcam.matrix() - kFirstCam.matrix()).norm(), 1e-12);
    ASSERT_EQ(file.rows.size(), 1U);
    const auto& row = file.rows[0];
    EXPECT_EQ(row.line, 4U);
    EXPECT_EQ(row.objectId, 4);
    EXPECT_EQ(row.objectClass, djpete::obs::ObjectClass::Van);
    EXPECT_EQ(row.frame, 11U);
    EXPECT_NEAR(row.time_s.value(), 1.1, 1e-12);
    EXPECT_LT((row.T_world_obj.matrix() - T.matrix()).norm(), 1e-12);
    EXPECT_EQ(row.size_m, Vec3(4, 1.8, 1.5));
    EXPECT_EQ(row.velocity_world, Vec3(1, 2, 3));
    EXPECT_EQ(row.sigma_m, Vec3(0.1, 0.1, 0.1));
    EXPECT_EQ(row.sigmaYaw_rad, 0.1);
    EXPECT_EQ(row.observations, 3U);
    EXPECT_TRUE(row.moving);
}

TEST_F(ObjectsCsv, HeaderHasOneNamePerColumn) {
    const std::string header = kObjectsCsvHeader;
    const std::string row = csvRow(0, "Car", 0, SE3());
    EXPECT_EQ(std::count(header.begin(), header.end(), ','), 22);
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), 22);
}

TEST_F(ObjectsCsv, AMapWithoutObjectsIsFine) {
    EXPECT_TRUE(readObjectsCsv(write(csvPreamble(0, kFirstCam))).rows.empty());
}

TEST_F(ObjectsCsv, RefusesAnIncompletePreamble) {
    const std::string header = std::string(kObjectsCsvHeader) + "\n";
    const std::string matrix = "# T_world_firstcam " + kittiRow(SE3()) + "\n";
    EXPECT_INPUT_ERROR(readObjectsCsv(write(matrix + header)), "o.csv", "first_frame");
    EXPECT_INPUT_ERROR(readObjectsCsv(write("# first_frame 0\n" + header)), "o.csv",
                       "T_world_firstcam");
    EXPECT_INPUT_ERROR(readObjectsCsv(write("# first_frame 0\n" + matrix)), "o.csv", "header line");
    EXPECT_INPUT_ERROR(readObjectsCsv(write("# first_frame -1\n")), "o.csv:1", "first_frame");
    EXPECT_INPUT_ERROR(readObjectsCsv(write("# T_world_firstcam 1 0 0\n")), "o.csv:1", "12", "3");
    EXPECT_INPUT_ERROR(readObjectsCsv(write(matrix + "id,class\n")), "o.csv:2", "object_id,class");
    EXPECT_INPUT_ERROR(readObjectsCsv(dir_ / "none.csv"), "none.csv", "no such file");
}

TEST_F(ObjectsCsv, RefusesBadFieldsNamingTheLine) {
    EXPECT_NO_THROW(readObjectsCsv(withField(99, "")));
    EXPECT_FALSE(readObjectsCsv(withField(3, "")).rows.at(0).time_s.has_value());
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(3, "nan")), "o.csv:4", "time_s");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(0, "-4")), "o.csv:4", "object_id");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(2, "1.5")), "o.csv:4", "frame", "1.5");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(4, "nan")), "o.csv:4", "x", "nan");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(4, "")), "o.csv:4", "x");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(7, "1")), "o.csv:4", "rotation");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(11, "0")), "o.csv:4", "above 0");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(14, "inf")), "o.csv:4", "velocity");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(17, "-1")), "o.csv:4", "sigma");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(21, "0")), "o.csv:4", "observations");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(22, "2")), "o.csv:4", "moving");
    EXPECT_INPUT_ERROR(readObjectsCsv(withField(22, "1,1")), "o.csv:4", "23 columns", "got 24");
    const std::string row = csvRow(4, "Car", 11, SE3());
    EXPECT_INPUT_ERROR(readObjectsCsv(write(csvPreamble(0, SE3()) + row + row)), "o.csv:5",
                       "object 4", "frame 11");
}
