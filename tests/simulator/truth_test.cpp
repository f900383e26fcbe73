// Labels, masks, scans and poses speak of the same cars.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "drive_files.h"

namespace {

using namespace djpete::simulator;
using djpete::geometry::Cuboid;
using djpete::geometry::Mat3;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using djpete_test::ScratchFolder;

/// Frames of a drive as a reader of the labels sees them.
class Truth : public ::testing::Test {
  protected:
    Truth() : world(options()), renderer(world, 2), camera(rigCamera(620, 188)) {}
    static WorldOptions options() {
        WorldOptions o;
        o.seed = 5;
        return o;
    }
    std::vector<Label> labelsAt(uint64_t frame) {
        image = renderer.renderCamera(frame, camera, T_vehicle_camera(), 0);
        return makeLabels(renderer, world, frame, camera, T_vehicle_camera(), image, {});
    }
    /// From the label's numbers alone, as KITTI defines them.
    static SE3 T_cam_objOf(const Label& l) {
        Mat3 R;
        R.col(0) = Vec3(std::cos(l.rotationY_rad), 0, -std::sin(l.rotationY_rad));
        R.col(2) = Vec3(0, -1, 0);
        R.col(1) = R.col(2).cross(R.col(0));
        return {R, Vec3(l.x_m, l.y_m - 0.5 * l.height_m, l.z_m)};
    }

    World world;
    Renderer renderer;
    djpete::geometry::StereoCamera camera;
    RenderedImage image;
};

TEST_F(Truth, MaskOfAFreeCarFillsItsImageBox) {
    int checked = 0;
    for (uint64_t frame : {0U, 20U, 40U, 60U}) {
        for (const auto& l : labelsAt(frame)) {
            if (l.occlusion > 0 || l.truncation > 0 || l.bottom - l.top < 15) continue;
            double left = 1e9, right = -1, top = 1e9, bottom = -1;
            for (int v = 0; v < camera.height_px; ++v) {
                for (int u = 0; u < camera.width_px; ++u) {
                    if (image.carId[static_cast<std::size_t>(v * camera.width_px + u)] != l.trackId)
                        continue;
                    left = std::min<double>(left, u);
                    right = std::max<double>(right, u);
                    top = std::min<double>(top, v);
                    bottom = std::max<double>(bottom, v);
                }
            }
            const double w = std::min(right, l.right) - std::max(left, l.left);
            const double h = std::min(bottom, l.bottom) - std::max(top, l.top);
            const double inter = std::max(0.0, w) * std::max(0.0, h);
            const double both =
                (right - left) * (bottom - top) + (l.right - l.left) * (l.bottom - l.top) - inter;
            // Free means at least 80 % visible, so a part may be hidden.
            EXPECT_GT(inter / both, 0.70) << "frame " << frame << " car " << l.trackId;
            EXPECT_GE(left, l.left - 1);
            EXPECT_LE(right, l.right + 1);
            EXPECT_GE(top, l.top - 1);
            EXPECT_LE(bottom, l.bottom + 1);
            ++checked;
        }
    }
    EXPECT_GE(checked, 8);
}

TEST_F(Truth, ScanPointsOfACarLieInItsLabelledBox) {
    const SE3 T_cam_velo = T_vehicle_camera().inverse();
    LidarOptions lidar;
    int cars = 0;
    for (uint64_t frame : {3U, 50U}) {
        const auto labels = labelsAt(frame);
        const auto scan = renderer.scan(frame, lidar);
        for (const auto& l : labels) {
            const SE3 T_obj_velo = T_cam_objOf(l).inverse() * T_cam_velo;
            // Range noise is bounded by 3.5 sigma; the label knows no pitch and roll (half a
            // degree).
            const double margin_m = 3.5 * lidar.rangeNoise_m + 0.03;
            const Cuboid box{{l.length_m, l.width_m, l.height_m}};
            std::size_t points = 0, inside = 0;
            for (const auto& p : scan) {
                if (p.carId != l.trackId) continue;
                ++points;
                inside +=
                    box.contains(T_obj_velo * Vec3(double(p.x), double(p.y), double(p.z)), margin_m)
                        ? 1U
                        : 0U;
            }
            EXPECT_EQ(inside, points) << "car " << l.trackId;
            if (l.z_m < 15 && l.occlusion == 0) {
                EXPECT_GT(points, 100U) << "car " << l.trackId;
                ++cars;
            }
        }
    }
    EXPECT_GE(cars, 3);
}

TEST_F(Truth, ScanLooksLikeAVelodynes) {
    const auto scan = renderer.scan(0, {});
    EXPECT_GT(scan.size(), 70000U);
    EXPECT_LT(scan.size(), 64U * 1800);
    std::size_t ground = 0;
    for (const auto& p : scan) {
        EXPECT_LE(std::hypot(p.x, p.y, p.z), 80.2F);
        EXPECT_GE(p.reflectance, 0.F);
        EXPECT_LT(p.reflectance, 1.F);
        ground += std::abs(p.z + 1.73F) < 0.3F && std::hypot(p.x, p.y) < 15.F ? 1U : 0U;
    }
    EXPECT_GT(ground, scan.size() / 8);  // the street lies 1.73 m below the sensor
}

TEST_F(Truth, DetectionsErrAsAsked) {
    DetectorNoise noise;
    noise.missRate = 0.25;
    std::vector<Label> labels(4000);
    for (uint32_t i = 0; i < labels.size(); ++i) {
        labels[i].frame = i / 10;
        labels[i].trackId = i;
        labels[i].z_m = 20;
    }
    const auto found = makeDetections(labels, noise, 1);
    EXPECT_NEAR(static_cast<double>(found.size()), 3000, 120);
    double sum = 0, square = 0, turn = 0;
    for (const auto& d : found) {
        sum += d.label.x_m;
        square += d.label.x_m * d.label.x_m;
        turn += d.label.rotationY_rad * d.label.rotationY_rad;
    }
    const auto n = static_cast<double>(found.size());
    EXPECT_NEAR(sum / n, 0, 0.02);
    EXPECT_NEAR(std::sqrt(square / n), 0.3, 0.02);
    EXPECT_NEAR(std::sqrt(turn / n), noise.sigma_rad, 0.006);
}

TEST(DriveFiles, MasksAndLabelsNameTheSameCars) {
    auto options = djpete_test::smallDrive();
    options.width_px = 620;
    options.height_px = 188;
    options.scans = false;
    const ScratchFolder folder("ids");
    writeDrive(options, folder.path(), nullptr);
    std::map<int, std::set<int>> labelled, masked;
    for (const auto& row : djpete_test::numbersOf(folder.path() / "label_02.txt")) {
        ASSERT_EQ(row.size(), 16U);  // and the type, a word
        labelled[static_cast<int>(row[0])].insert(static_cast<int>(row[1]));
    }
    for (int f = 0; f < 3; ++f) {
        const auto file = folder.path() / "instances" / ("00000" + std::to_string(f) + ".png");
        const cv::Mat mask = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
        ASSERT_EQ(mask.type(), CV_16UC1);
        for (auto it = mask.begin<uint16_t>(); it != mask.end<uint16_t>(); ++it) {
            if (*it == 0 || *it == 10000) continue;
            EXPECT_EQ(*it / 1000, 1);
            masked[f].insert(*it % 1000);
        }
        EXPECT_EQ(masked[f], labelled[f]) << "frame " << f;
        EXPECT_GE(masked[f].size(), 3U);
    }
}

TEST(DriveFiles, PosesTimesAndCalibrationAreKittis) {
    auto options = djpete_test::smallDrive();
    options.scans = false;
    const ScratchFolder folder("poses");
    writeDrive(options, folder.path(), nullptr);
    const auto times = djpete_test::numbersOf(folder.path() / "times.txt");
    const auto poses = djpete_test::numbersOf(folder.path() / "poses.txt");
    ASSERT_EQ(times.size(), 3U);
    ASSERT_EQ(poses.size(), 3U);
    EXPECT_NEAR(times[2].at(0), 0.2, 1e-9);
    for (int i = 0; i < 12; ++i)
        EXPECT_NEAR(poses[0].at(static_cast<std::size_t>(i)), i % 5 == 0 ? 1 : 0, 1e-12);
    EXPECT_NEAR(poses[2].at(11), 2 * options.world.step_m, 0.05);  // ahead is z of the camera
    EXPECT_NEAR(poses[2].at(3), 0, 0.1);
    const auto calib = djpete_test::numbersOf(folder.path() / "calib.txt");
    ASSERT_EQ(calib.size(), 5U);
    const auto camera = rigCamera(options.width_px, options.height_px);
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(calib[i].size(), 12U);
        EXPECT_NEAR(calib[i][0], camera.fx, 1e-9);
        EXPECT_NEAR(calib[i][3], i % 2 ? -camera.fx * camera.baseline_m : 0, 1e-9);
    }
    // Tr maps velodyne to camera: what lies ahead of the one lies ahead of the other.
    EXPECT_NEAR(calib[4].at(8), 1, 1e-3);
    EXPECT_NEAR(calib[4].at(1), -1, 1e-3);
    EXPECT_NEAR(calib[4].at(6), -1, 1e-3);
}

TEST(DriveFiles, AFolderThatCannotBeMadeIsNamed) {
    const ScratchFolder folder("unwritable");
    const auto file = folder.path() / "a_file";
    std::ofstream(file) << "x";
    try {
        writeDrive(djpete_test::smallDrive(), file / "drive", nullptr);
        FAIL() << "no error";
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("a_file"), std::string::npos) << e.what();
    }
}

}  // namespace
