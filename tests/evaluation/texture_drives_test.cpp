/// Folders of drives and results, curves, and the command line of --textures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "djpete/evaluation/estimated_drive.h"
#include "djpete/evaluation/texture_curve.h"
#include "djpete/obs/errors.h"
#include "djpete_eval_app.h"

namespace djpete::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
namespace fs = std::filesystem;

/// Frames 3 to 8; object 0 stands, object 1 drives 1 m a frame.
fs::path resultFolder() {
    const fs::path folder = fs::path(testing::TempDir()) / "djpete_texture_result";
    fs::create_directories(folder);
    std::ofstream poses(folder / "trajectory.kitti.txt");
    for (int i = 0; i < 6; ++i) poses << "1 0 0 0 0 1 0 0 0 0 1 " << i << '\n';
    std::ofstream objects(folder / "objects.csv");
    objects << "# T_world_firstcam 1 0 0 0 0 1 0 0 0 0 1 0\n# first_frame 3\n"
            << kObjectsCsvHeader << '\n';
    const auto row = [&](int id, int frame, double z, int moving) {
        objects << id << ",Car," << frame << ",0.1,0,0," << z
                << ",0,0,0,1,4,2,1.5,0,0,0,0.1,0.1,0.1,0.1,5," << moving << '\n';
    };
    row(0, 4, 20, 0);
    row(1, 4, 10, 1);
    row(1, 6, 12, 1);
    std::ofstream nodes(folder / "map.graph.nodes.csv");
    nodes << "node,kind,keyframe_id,object_id,frame\n0,keyframe,0,,4\n1,keyframe,1,,6\n"
             "2,object,,0,\n";
    return folder;
}

TEST(EstimatedDrive, posesOfFramesBetweenAndBeyond) {
    const auto drive = readEstimatedDrive(resultFolder().string());
    EXPECT_THAT(drive.keyframes, ElementsAre(4, 6));
    EXPECT_NEAR(drive.T_world_obj(1, 5)->translation().z(), 11, 1e-12);
    EXPECT_EQ(drive.T_world_obj(1, 7), std::nullopt);  // moves: nobody knows where
    EXPECT_NEAR(drive.T_world_obj(0, 8)->translation().z(), 20, 1e-12);
    EXPECT_NEAR(drive.T_cam_obj(0, 8)->translation().z(), 15, 1e-12);
    EXPECT_EQ(drive.T_cam_obj(0, 9), std::nullopt);
    EXPECT_EQ(drive.T_world_obj(2, 4), std::nullopt);
}

TEST(EstimatedDrive, disturbanceIsAsLargeAsAskedAndAnotherEachTime) {
    auto drive = readEstimatedDrive(resultFolder().string());
    const auto before = *drive.T_world_obj(0, 4);
    drive.disturbance = {0.2, 3};
    const auto a = before.inverse() * *drive.T_world_obj(0, 4);
    const auto b = before.inverse() * *drive.T_world_obj(0, 5);
    for (const auto& d : {a, b}) {
        EXPECT_NEAR(d.translation().norm(), 0.2, 1e-9);
        EXPECT_NEAR(d.translation().z(), 0, 1e-12);
        EXPECT_NEAR(d.angle_rad(), 3 * M_PI / 180, 1e-9);
    }
    EXPECT_GT((a.translation() - b.translation()).norm(), 1e-3);
}

ObjectCurve curveOf(const std::vector<double>& errors) {
    ObjectCurve out;
    for (double e : errors) {
        CurvePoint p;
        p.step = out.points.size() + 1;
        p.imageError = e;
        out.points.push_back(p);
    }
    return out;
}

TEST(TextureCurve, fallsIfTheLastIsBelowTheFirst) {
    TextureCurves curves;
    curves.objects = {curveOf({8, 6, 7, 4}), curveOf({2, 3}), curveOf({5})};
    const auto summary = summariseCurves(curves, &CurvePoint::imageError);
    EXPECT_EQ(summary.objects, 2U);  // one view makes no curve
    EXPECT_EQ(summary.objectsFalling, 1U);
    EXPECT_EQ(summary.steps, 4U);
    EXPECT_EQ(summary.stepsFalling, 2U);
    EXPECT_THAT(meanCurve(curves, &CurvePoint::imageError), ElementsAre(5, 14.0 / 3, 5, 4));
}

TEST(TextureOptions, commandLinesThatMakeNoSense) {
    const auto parse = [](std::vector<const char*> words) {
        return [words] {
            std::vector<const char*> all{"djpete-eval"};
            all.insert(all.end(), words.begin(), words.end());
            apps::DjpeteEvalApp app;
            app.initialize(static_cast<int>(all.size()), all.data());
        };
    };
    EXPECT_THAT(parse({"--textures", "r"}),
                ThrowsMessage<obs::InputError>(HasSubstr("--textures and --drive")));
    EXPECT_THAT(parse({"--textures", "r", "--drive", "d", "--truth", "t"}),
                ThrowsMessage<obs::InputError>(HasSubstr("--textures goes with")));
    EXPECT_THAT(parse({"--textures", "r", "--drive", "d", "--disturb", "0.2"}),
                ThrowsMessage<obs::InputError>(HasSubstr("disturbance '0.2'")));
    EXPECT_THAT(parse({"--trajectory", "t", "--truth", "g", "--strips", "s"}),
                ThrowsMessage<obs::InputError>(HasSubstr("need --textures")));
    EXPECT_NO_THROW(parse({"--textures", "r", "--drive", "d", "--disturb", "0.2,3"})());
}

}  // namespace
}  // namespace djpete::evaluation
