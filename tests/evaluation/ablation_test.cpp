/// djpete-eval --ablation.
#include <nlohmann/json.hpp>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete_eval_app.h"
#include "evaluation_worlds.h"

using namespace evaluation_test;
using djpete::apps::DjpeteEvalApp;
using ::testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

std::string runApp(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"djpete-eval"};
    for (const auto& a : arguments) argv.push_back(a.c_str());
    DjpeteEvalApp app;
    std::ostringstream out;
    if (app.initialize(static_cast<int>(argv.size()), argv.data())) app.run(out);
    return out.str();
}

/// A drive of 12 frames with a car. off and worker end 0.4 m too high, joint is right; worker has
/// the car 0.5 m off, joint 0.1 m.
class Ablation : public ::testing::Test {
  protected:
    Ablation() {
        auto truth = windingPath(12);
        auto drifting = truth;
        for (std::size_t f = 0; f < 12; ++f) {
            drifting[f].translation().y() += 0.4 * static_cast<double>(f % 2);
        }
        const SE3 axes = djpete::geometry::opticalToVehicleAxes();
        std::string labels, worker = csvPreamble(0, axes), joint = worker;
        for (std::size_t f = 0; f < 12; ++f) {
            const SE3 T_cam_obj = (axes * truth[f]).inverse() * SE3::fromYaw(0, {20, 0, 0});
            const Vec3 axis = T_cam_obj.rotation().col(0), t = T_cam_obj.translation();
            std::ostringstream row;
            row << std::setprecision(12) << f << " 0 Car 0 0 0 1 1 2 2 1.5 1.8 4 " << t.x() << " "
                << t.y() + 0.75 << " " << t.z() << " " << std::atan2(-axis.z(), axis.x()) << "\n";
            labels += row.str();
            worker += csvRow(3, "Car", f, SE3::fromYaw(0, {20, 0.5, 0}));
            joint += csvRow(3, "Car", f, SE3::fromYaw(0, {20, 0.1, 0}));
        }
        for (const char* mode : {"off", "worker", "joint"}) fs::create_directories(dir_ / mode);
        writeText(dir_ / "truth.txt", kittiText(truth));
        writeText(dir_ / "labels.txt", labels);
        writeText(dir_ / "off/trajectory.kitti.txt", kittiText(drifting));
        writeText(dir_ / "worker/trajectory.kitti.txt", kittiText(drifting));
        writeText(dir_ / "joint/trajectory.kitti.txt", kittiText(truth));
        writeText(dir_ / "worker/objects.csv", worker);
        writeText(dir_ / "joint/objects.csv", joint);
    }
    nlohmann::json json(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"--ablation", dir_, "--json"});
        return nlohmann::json::parse(runApp(more));
    }
    const fs::path dir_ = djpete_test::scratch("ablation_drive");
};

}  // namespace

TEST_F(Ablation, ComparesTheRunsOfADrive) {
    const auto j = json({"--world-from-truth"});
    ASSERT_EQ(j.size(), 1U);
    EXPECT_EQ(j[0]["name"], dir_.filename().string());
    const auto& runs = j[0]["runs"];
    ASSERT_EQ(runs.size(), 3U);
    const std::vector<std::string> modes{"off", "worker", "joint"};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(runs[i]["mode"], modes[i]);
    EXPECT_EQ(runs[1]["same_path_as_off"], true);
    EXPECT_EQ(runs[2]["same_path_as_off"], false);
    EXPECT_NEAR(runs[0]["ate_se3_m"].get<double>(), 0.2, 0.01) << "0 and 0.4 m in turn";
    EXPECT_EQ(runs[0]["ate_se3_m"], runs[1]["ate_se3_m"]);
    EXPECT_LT(runs[2]["ate_se3_m"].get<double>(), 1e-9);
    EXPECT_FALSE(runs[0].contains("objects_labelled")) << "off has no objects.csv";
    EXPECT_EQ(runs[1]["objects_matched_one_to_one"], 1);
    EXPECT_NEAR(runs[1]["centre_error_median_m"].get<double>(), 0.5, 1e-6);
    EXPECT_NEAR(runs[2]["centre_error_median_m"].get<double>(), 0.1, 1e-6);
    EXPECT_NEAR(runs[2]["yaw_error_median_deg"].get<double>(), 0, 1);
}

TEST_F(Ablation, OneDifferentByteIsAnotherPath) {
    std::ofstream(dir_ / "worker/trajectory.kitti.txt", std::ios::app) << "\n";
    EXPECT_EQ(json()[0]["runs"][1]["same_path_as_off"], false);
}

TEST_F(Ablation, TableHasOneLinePerRunAndDrive) {
    const auto text = runApp({"--ablation", dir_, dir_, "--range", "0:12"});
    std::istringstream lines(text);
    int headings = 0, runs = 0;
    for (std::string line; std::getline(lines, line);) {
        headings += line == dir_.filename().string() + ", 12 frames" ? 1 : 0;
        for (const std::string mode : {"  off ", "  worker ", "  joint "}) {
            runs += line.compare(0, mode.size(), mode) == 0 ? 1 : 0;
        }
    }
    EXPECT_EQ(headings, 2);
    EXPECT_EQ(runs, 6);
    EXPECT_THAT(text, HasSubstr("same path"));
}

TEST_F(Ablation, WithoutLabelsThePathsAreCompared) {
    fs::remove(dir_ / "labels.txt");
    const auto j = json();
    EXPECT_FALSE(j[0]["runs"][2].contains("objects_labelled"));
    EXPECT_TRUE(j[0]["runs"][2]["ate_se3_m"].is_number());
}

TEST_F(Ablation, NamesWhatIsMissing) {
    EXPECT_INPUT_ERROR(runApp({"--ablation", "no/such"}), "no/such", "expected a folder");
    EXPECT_INPUT_ERROR(runApp({"--ablation", dir_, "--truth", "t"}), "--ablation");
    EXPECT_INPUT_ERROR(runApp({"--ablation", dir_, "--bev"}), "--bev");
    fs::remove(dir_ / "joint/objects.csv");
    EXPECT_INPUT_ERROR(json(), "joint/objects.csv", "no such file");
    fs::remove(dir_ / "worker/trajectory.kitti.txt");
    EXPECT_INPUT_ERROR(json(), "worker/trajectory.kitti.txt", "no such file");
    fs::remove(dir_ / "truth.txt");
    EXPECT_INPUT_ERROR(json(), "truth.txt", "no such file");
}
