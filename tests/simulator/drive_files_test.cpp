/// The written drive: the same bytes for the same seed, and tables that agree with each other.
#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "small_drive.h"

using namespace small_drive;
using testing::HasSubstr;

namespace {

/// A drive of three frames of a quarter of KITTI's size, in a folder of its own.
fs::path drive(const std::string& name, const std::string& seed, const std::string& threads,
               const std::string& frames = "0:3") {
    const auto dir = djpete_test::scratch("sim_" + name);
    simulate({"--out", dir.string(), "--frames", frames, "--size", "310x94", "--seed", seed,
              "--threads", threads});
    return dir;
}

}  // namespace

TEST(SimulatedFiles, AreTheSameBytesForASeedAndAnyNumberOfThreads) {
    const auto once = filesOf(drive("once", "7", "1"));
    // 3 frames of 4 images, instances, a scan and OXTS; calib, calib_imu_to_velo, times, poses,
    // labels, detections, objects, exposure, moving, drive_options.
    ASSERT_EQ(once.size(), 3U * 7U + 10U);
    for (const auto& [name, bytes] : once) EXPECT_FALSE(bytes.empty()) << name;
    for (const char* threads : {"1", "2", "4"}) {
        const auto again = filesOf(drive("again", "7", threads));
        ASSERT_EQ(again.size(), once.size());
        for (const auto& [name, bytes] : once) {
            EXPECT_TRUE(again.at(name) == bytes) << name << " with " << threads << " threads";
        }
    }
}

TEST(SimulatedFiles, DifferForAnotherSeed) {
    const auto a = filesOf(drive("seed_a", "1", "2", "0:1"));
    const auto b = filesOf(drive("seed_b", "2", "2", "0:1"));
    for (const char* name : {"image_0/000000.png", "image_3/000000.png", "velodyne/000000.bin",
                             "instances/000000.png", "label_02.txt", "detections.txt"}) {
        EXPECT_FALSE(a.at(name) == b.at(name)) << name;
    }
    EXPECT_TRUE(a.at("calib.txt") == b.at("calib.txt"));
}

TEST(SimulatedFiles, OfAFrameDoNotDependOnWhereTheRangeStarts) {
    const auto whole = filesOf(drive("whole", "5", "2", "0:3"));
    const auto part = filesOf(drive("part", "5", "2", "2:3"));
    for (const auto& [name, bytes] : part) {
        if (name.find("000002") != std::string::npos) {
            EXPECT_TRUE(whole.at(name) == bytes) << name;
        }
    }
    EXPECT_TRUE(whole.at("poses.txt") == part.at("poses.txt"));
    EXPECT_THAT(whole.at("label_02.txt"), HasSubstr(part.at("label_02.txt")));
}

TEST(SimulatedFiles, TablesHaveARowPerFrameAndSayWhereTheRigIs) {
    const auto dir = drive("tables", "3", "2");
    const auto times = numbersOf(dir / "times.txt");
    const auto poses = numbersOf(dir / "poses.txt");
    ASSERT_EQ(times.size(), 3U);
    ASSERT_EQ(poses.size(), 3U);
    sim::WorldOptions options;
    options.seed = 3;
    options.frames = 3;
    const sim::World world(options);
    for (uint64_t f = 0; f < 3; ++f) {
        ASSERT_EQ(times[f].size(), 1U);
        EXPECT_NEAR(times[f][0], 0.1 * static_cast<double>(f), 1e-9);
        const SE3 T_cam0_cam = (world.T_world_vehicle(0) * sim::T_vehicle_camera()).inverse() *
                               world.T_world_vehicle(f) * sim::T_vehicle_camera();
        ASSERT_EQ(poses[f].size(), 12U);
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 4; ++c) {
                EXPECT_NEAR(poses[f][static_cast<std::size_t>(4 * r + c)],
                            T_cam0_cam.matrix()(r, c), 1e-9);
            }
        }
    }
    EXPECT_NEAR(poses[2][11], 1.6, 0.02);  // two steps of 0.8 m ahead
}

TEST(SimulatedFiles, CalibrationIsTheRig) {
    const auto dir = drive("calib", "3", "2", "0:1");
    std::istringstream in(textOf(dir / "calib.txt"));
    const auto camera = sim::rigCamera(310, 94);
    const SE3 T_cam_velo = sim::T_vehicle_camera().inverse();
    for (const char* key : {"P0:", "P1:", "P2:", "P3:", "Tr:"}) {
        std::string word;
        in >> word;
        ASSERT_EQ(word, key);
        Eigen::Matrix<double, 3, 4> m;
        for (int i = 0; i < 12; ++i) in >> m(i / 4, i % 4);
        ASSERT_TRUE(in) << key;
        Eigen::Matrix<double, 3, 4> expected = Eigen::Matrix<double, 3, 4>::Zero();
        if (word == "Tr:") {
            expected = T_cam_velo.matrix().topRows<3>();
        } else {
            expected.leftCols<3>() << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
            if (word == "P1:" || word == "P3:") expected(0, 3) = -camera.fx * camera.baseline_m;
        }
        EXPECT_LT((m - expected).cwiseAbs().maxCoeff(), 1e-6) << key;
    }
}

TEST(SimulatedFiles, PicturesHaveKittisFormats) {
    const auto dir = drive("formats", "3", "2", "0:1");
    for (int i = 0; i < 4; ++i) {
        const auto file = dir / ("image_" + std::to_string(i)) / "000000.png";
        const cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
        EXPECT_EQ(image.type(), i < 2 ? CV_8UC1 : CV_8UC3) << file;
        EXPECT_EQ(image.size(), cv::Size(310, 94)) << file;
    }
    const cv::Mat ids =
        cv::imread((dir / "instances" / "000000.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(ids.type(), CV_16UC1);
    int cars = 0;
    for (int v = 0; v < ids.rows; ++v) {
        for (int u = 0; u < ids.cols; ++u) {
            const int id = ids.at<uint16_t>(v, u);
            EXPECT_TRUE(id == 0 || id / 1000 == 1 || id / 1000 == 2 || id == 10000) << id;
            cars += id != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(cars, 500);
    EXPECT_EQ(fs::file_size(dir / "velodyne" / "000000.bin") % 16, 0U);
}

TEST(SimulatedFiles, ScansCanBeLeftOut) {
    const auto dir = djpete_test::scratch("sim_no_scans");
    simulate({"--out", dir.string(), "--frames", "0:1", "--size", "310x94", "--no-scans"});
    EXPECT_FALSE(fs::exists(dir / "velodyne"));
    EXPECT_TRUE(fs::exists(dir / "image_1" / "000000.png"));
}
