#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "djpete/io/objects_csv.h"
#include "djpete/io/trajectory_writer.h"
#include "djpete/obs/errors.h"
#include "small_map.h"

namespace {

using namespace djpete_test;

SE3 truth(std::size_t line) {
    return cameraPose(0).inverse() * cameraPose(static_cast<double>(line));
}

TEST(TrajectoryWriter, TumHoldsEveryFrameFromTheFirstCamera) {
    const TestFolder folder;
    io::writeTrajectoryTum(smallMap(), folder / "trajectory.tum");
    const auto lines = linesOf(folder / "trajectory.tum");
    ASSERT_EQ(lines.size(), 5U);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto v = numbersOf(lines[i]);
        ASSERT_EQ(v.size(), 8U);
        EXPECT_NEAR(v[0], kStart_s + 0.1 * static_cast<double>(i), 1e-6);
        const SE3 read(Eigen::Quaterniond(v[7], v[4], v[5], v[6]).toRotationMatrix(),
                       Vec3(v[1], v[2], v[3]));
        EXPECT_LT((truth(i).inverse() * read).log().norm(), 1e-10);
    }
    EXPECT_THAT(lines[1], testing::StartsWith("1317617735.3500000 "));
}

TEST(TrajectoryWriter, KittiHoldsThreeByFourMatrices) {
    const TestFolder folder;
    io::writeTrajectoryKitti(smallMap(), folder / "t.txt");
    const auto lines = linesOf(folder / "t.txt");
    ASSERT_EQ(lines.size(), 5U);
    EXPECT_EQ(lines[0], "1 0 0 0 0 1 0 0 0 0 1 0");
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto v = numbersOf(lines[i]);
        ASSERT_EQ(v.size(), 12U);
        const Eigen::Matrix4d T = truth(i).matrix();
        for (int k = 0; k < 12; ++k)
            EXPECT_NEAR(v[static_cast<std::size_t>(k)], T(k / 4, k % 4), 1e-10);
    }
}

TEST(TrajectoryWriter, AnEmptyMapMakesAnEmptyFile) {
    const TestFolder folder;
    io::writeTrajectoryTum(map::SlamMap(), folder / "t.tum");
    io::writeTrajectoryKitti(map::SlamMap(), folder / "t.txt");
    EXPECT_TRUE(linesOf(folder / "t.tum").empty());
    EXPECT_TRUE(linesOf(folder / "t.txt").empty());
}

TEST(ObjectsCsv, HasTheAgreedColumnsAndValues) {
    const TestFolder folder;
    io::writeObjectsCsv(smallMap(), folder / "objects.csv");
    const auto lines = linesOf(folder / "objects.csv");
    ASSERT_EQ(lines.size(), 3U + 8U);
    ASSERT_THAT(lines[0], testing::StartsWith("# T_world_firstcam "));
    const auto header = numbersOf(lines[0].substr(19));
    ASSERT_EQ(header.size(), 12U);
    const Eigen::Matrix4d T = cameraPose(0).matrix();
    for (int k = 0; k < 12; ++k)
        EXPECT_NEAR(header[static_cast<std::size_t>(k)], T(k / 4, k % 4), 1e-10);
    EXPECT_EQ(lines[1], "# first_frame 3");
    EXPECT_EQ(lines[2],
              "object_id,class,frame,time_s,x,y,z,qx,qy,qz,qw,length,width,height,vx,vy,vz,"
              "sigma_x,sigma_y,sigma_z,sigma_yaw,observations,moving");
    const auto parked = cellsOf(lines[3 + 1]);  // object 0 at frame 4
    ASSERT_EQ(parked.size(), 23U);
    EXPECT_EQ(parked[0], "0");
    EXPECT_EQ(parked[1], "Car");
    EXPECT_EQ(parked[2], "4");
    EXPECT_EQ(parked[3], "1317617735.3500000");
    EXPECT_NEAR(std::stod(parked[4]), 12.123456789012, 1e-9);
    EXPECT_NEAR(std::stod(parked[9]), std::sin(0.15), 1e-10);
    EXPECT_NEAR(std::stod(parked[10]), std::cos(0.15), 1e-10);
    EXPECT_EQ(parked[11], "4.1");
    EXPECT_EQ(std::stod(parked[14]), 0);
    EXPECT_NEAR(std::stod(parked[17]), 0.1, 1e-12);
    EXPECT_NEAR(std::stod(parked[18]), 0.2, 1e-12);
    EXPECT_NEAR(std::stod(parked[19]), 0.3, 1e-12);
    EXPECT_NEAR(std::stod(parked[20]), 0.05, 1e-12);
    EXPECT_EQ(parked[21], "4");
    EXPECT_EQ(parked[22], "0");
    const auto driving = cellsOf(lines[3 + 4]);  // object 1 at frame 3, heading +y
    EXPECT_EQ(driving[0], "1");
    EXPECT_EQ(driving[1], "Van");
    EXPECT_NEAR(std::stod(driving[14]), -1, 1e-9);  // left of the car is world -x
    EXPECT_NEAR(std::stod(driving[15]), 10, 1e-9);
    EXPECT_EQ(driving[22], "1");
}

TEST(Writers, NameTheFileThatCannotBeWritten) {
    const auto message = [](auto write) -> std::string {
        try {
            write(std::string("/nowhere/at/all/file"));
        } catch (const obs::InputError& e) {
            return e.what();
        }
        return "no error";
    };
    const auto map = smallMap();
    const auto says = testing::StartsWith("/nowhere/at/all/file: cannot be written");
    EXPECT_THAT(message([&](const auto& f) { io::writeTrajectoryTum(map, f); }), says);
    EXPECT_THAT(message([&](const auto& f) { io::writeTrajectoryKitti(map, f); }), says);
    EXPECT_THAT(message([&](const auto& f) { io::writeObjectsCsv(map, f); }), says);
}

}  // namespace
