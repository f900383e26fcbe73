#include "djpete/evaluation/trajectory_reader.h"

#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

const std::string kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

class TrajectoryReader : public ::testing::Test {
  protected:
    std::string write(const std::string& text) { return writeText(dir_ / "t.txt", text); }
    const std::filesystem::path dir_ = djpete_test::scratch("trajectory_reader");
};

}  // namespace

TEST_F(TrajectoryReader, ReadsKittiRows) {
    const auto path = windingPath(20);
    const auto file = readTrajectory(write(kittiText(path)));
    ASSERT_EQ(file.poses.size(), 20U);
    EXPECT_TRUE(file.stamps_s.empty());
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_LT((file.poses[i].matrix() - path[i].matrix()).norm(), 1e-12);
    }
}

TEST_F(TrajectoryReader, ReadsTumRowsWithComments) {
    const double h = std::sqrt(0.5);
    const auto file =
        readTrajectory(write("# t x y z qx qy qz qw\n0.5 1 2 3 0 0 0 1\n1.5 4 5 6 0 0 " +
                             std::to_string(h) + " " + std::to_string(h) + "\r\n\n"));
    ASSERT_EQ(file.poses.size(), 2U);
    EXPECT_EQ(file.stamps_s, (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(file.poses[0].translation(), Vec3(1, 2, 3));
    EXPECT_LT((file.poses[1].matrix() - SE3::fromYaw(M_PI / 2, {4, 5, 6}).matrix()).norm(), 1e-9);
}

TEST_F(TrajectoryReader, PutsRotationsOfFewDigitsBackOnSo3) {
    const auto file = readTrajectory(write("0.8776 -0.4794 0 1 0.4794 0.8776 0 2 0 0 1 3\n"));
    const Mat3 R = file.poses.at(0).rotation();
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-14);
}

TEST_F(TrajectoryReader, RefusesMissingEmptyAndFolder) {
    EXPECT_INPUT_ERROR(readTrajectory(dir_ / "none.txt"), "none.txt", "no such file");
    EXPECT_INPUT_ERROR(readTrajectory(dir_), "folder");
    EXPECT_INPUT_ERROR(readTrajectory(write("")), "t.txt", "empty");
    EXPECT_INPUT_ERROR(readTrajectory(write("\n \n")), "t.txt", "empty");
    EXPECT_INPUT_ERROR(readTrajectory(write("# nothing\n")), "t.txt", "no pose");
}

TEST_F(TrajectoryReader, RefusesWrongNumberOfColumnsNamingTheLine) {
    EXPECT_INPUT_ERROR(readTrajectory(write("1 0 0 0 0 1 0 0 0 0 1\n")), "t.txt:1", "got 11");
    EXPECT_INPUT_ERROR(readTrajectory(write(kIdentity + "\n1 0 0\n")), "t.txt:3", "expected 12",
                       "got 3");
    EXPECT_INPUT_ERROR(readTrajectory(write(kIdentity + "0 1 2 3 0 0 0 1\n")), "t.txt:2",
                       "expected 12", "got 8");
    EXPECT_INPUT_ERROR(readTrajectory(write("1,0,0,0,0,1,0,0,0,0,1,0\n")), "t.txt:1", "got 1");
}

TEST_F(TrajectoryReader, RefusesWhatIsNotAFiniteNumber) {
    for (const std::string bad : {"nan", "-inf", "1e999", "x", "0x1p3", "1.0.0", "+-1"}) {
        EXPECT_INPUT_ERROR(readTrajectory(write(kIdentity + "1 0 0 " + bad + " 0 1 0 0 0 0 1 0\n")),
                           "t.txt:2", "element 4", bad);
    }
    EXPECT_INPUT_ERROR(readTrajectory(write("nan 1 2 3 0 0 0 1\n")), "t.txt:1", "time", "nan");
    EXPECT_INPUT_ERROR(readTrajectory(write("1 0 0 1e300 0 1 0 0 0 0 1 0\n")), "t.txt:1", "1e9 m");
}

TEST_F(TrajectoryReader, RefusesWhatIsNotARotation) {
    EXPECT_INPUT_ERROR(readTrajectory(write("2 0 0 0 0 1 0 0 0 0 1 0\n")), "t.txt:1", "rotation");
    EXPECT_INPUT_ERROR(readTrajectory(write("1 0 0 0 0 1 0 0 0 0 -1 0\n")), "t.txt:1", "rotation");
    EXPECT_INPUT_ERROR(readTrajectory(write("0 0 0 0 0 0 0 0 0 0 0 0\n")), "t.txt:1", "rotation");
    EXPECT_INPUT_ERROR(readTrajectory(write("1 0.01 0 0 0 1 0 0 0 0 1 0\n")), "t.txt:1",
                       "rotation");
    EXPECT_INPUT_ERROR(readTrajectory(write("0 1 2 3 0 0 0 0\n")), "t.txt:1", "rotation");
    EXPECT_INPUT_ERROR(readTrajectory(write("0 1 2 3 0 0 0 1.01\n")), "t.txt:1", "rotation");
}

TEST_F(TrajectoryReader, RefusesTimesThatDoNotRise) {
    EXPECT_INPUT_ERROR(readTrajectory(write("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n")), "t.txt:2",
                       "time");
}
