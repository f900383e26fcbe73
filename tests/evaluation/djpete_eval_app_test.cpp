#include "djpete_eval_app.h"

#include <nlohmann/json.hpp>

#include "djpete/geometry/mrpt_bridge.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;
using djpete::apps::DjpeteEvalApp;
using ::testing::HasSubstr;

namespace {

std::string runApp(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"djpete-eval"};
    for (const auto& a : arguments) argv.push_back(a.c_str());
    DjpeteEvalApp app;
    std::ostringstream out;
    if (app.initialize(static_cast<int>(argv.size()), argv.data())) app.run(out);
    return out.str();
}

std::vector<std::string> keysOf(const nlohmann::ordered_json& j) {
    std::vector<std::string> keys;
    for (const auto& item : j.items()) keys.push_back(item.key());
    return keys;
}

const std::vector<std::string> kTrajectoryKeys{
    "ate_se3_m",     "ate_unaligned_m",    "ate_sim3_m", "sim3_scale",
    "t_rel_percent", "r_rel_deg_per_100m", "frames"};
const std::vector<std::string> kObjectKeys{"objects_labelled",     "objects_matched_one_to_one",
                                           "objects_duplicated",   "objects_missed",
                                           "objects_false",        "objects_without_switch",
                                           "object_switches",      "objects_seen_again",
                                           "objects_known_again",  "centre_error_median_m",
                                           "centre_error_p90_m",   "bev_error_median_m",
                                           "yaw_error_median_deg", "yaw_mod_pi_error_median_deg"};

/// Files of a run of 12 frames that ends 0.3 m off, with one car placed 0.25 m too high.
class EvalApp : public ::testing::Test {
  protected:
    EvalApp() {
        const auto truth = windingPath(12);
        Trajectory estimate = truth;
        const SE3 T_world_firstcam = djpete::geometry::opticalToVehicleAxes();
        const SE3 T_world_obj = SE3::fromYaw(0, {20, 0, 0});
        std::string labels, objects = csvPreamble(0, T_world_firstcam);
        for (std::size_t f = 0; f < 12; ++f) {
            estimate[f].translation().z() += 0.3 * static_cast<double>(f) / 11;
            objects += csvRow(3, "Car", f, SE3::fromYaw(0, {20, 0, 0.25}));
            labels += labelRow(f, (T_world_firstcam * estimate[f]).inverse() * T_world_obj);
        }
        estimateFile_ = writeText(dir_ / "estimate.txt", kittiText(estimate));
        truthFile_ = writeText(dir_ / "truth.txt", kittiText(truth));
        objectsFile_ = writeText(dir_ / "objects.csv", objects);
        labelsFile_ = writeText(dir_ / "labels.txt", labels);
    }
    static std::string labelRow(std::size_t frame, const SE3& T_cam_obj) {
        const Vec3 axis = T_cam_obj.rotation().col(0), t = T_cam_obj.translation();
        std::ostringstream out;
        out << std::setprecision(12) << frame << " 0 Car 0 0 0 1 1 2 2 1.5 1.8 4 " << t.x() << " "
            << t.y() + 0.75 << " " << t.z() << " " << std::atan2(-axis.z(), axis.x()) << "\n";
        return out.str();
    }
    const std::filesystem::path dir_ = djpete_test::scratch("djpete_eval_app");
    std::string estimateFile_, truthFile_, objectsFile_, labelsFile_;
};

}  // namespace

TEST_F(EvalApp, JsonHasExactlyTheKeysOfTheTrajectory) {
    const auto j = nlohmann::ordered_json::parse(
        runApp({"--trajectory", estimateFile_, "--truth", truthFile_, "--json"}));
    EXPECT_EQ(keysOf(j), kTrajectoryKeys);
    EXPECT_EQ(j["frames"], 12);
    EXPECT_TRUE(j["ate_se3_m"].is_number_float());
    EXPECT_GT(j["ate_unaligned_m"], 0.1);
    EXPECT_TRUE(j["t_rel_percent"].is_null()) << "12 m are no 100 m";
    EXPECT_TRUE(j["r_rel_deg_per_100m"].is_null());
}

TEST_F(EvalApp, JsonWithObjectsHasTheirKeysToo) {
    const auto j = nlohmann::ordered_json::parse(
        runApp({"--trajectory", estimateFile_, "--truth", truthFile_, "--json", "--objects",
                objectsFile_, "--labels", labelsFile_}));
    auto keys = kTrajectoryKeys;
    keys.insert(keys.end(), kObjectKeys.begin(), kObjectKeys.end());
    EXPECT_EQ(keysOf(j), keys);
    EXPECT_EQ(j["objects_labelled"], 1);
    EXPECT_EQ(j["objects_matched_one_to_one"], 1);
    EXPECT_EQ(j["objects_without_switch"], 1);
    EXPECT_EQ(j["objects_seen_again"], 0);
    EXPECT_NEAR(j["centre_error_median_m"].get<double>(), 0.25, 0.01);
    EXPECT_NEAR(j["bev_error_median_m"].get<double>(), 0, 0.01);
}

TEST_F(EvalApp, WithoutTruthOnlyObjectsAreEvaluated) {
    const auto j =
        nlohmann::ordered_json::parse(runApp({"--trajectory", estimateFile_, "--json", "--objects",
                                              objectsFile_, "--labels", labelsFile_}));
    EXPECT_TRUE(j["ate_se3_m"].is_null());
    EXPECT_EQ(j["frames"], 12);
    EXPECT_EQ(j["objects_matched_one_to_one"], 1);
}

TEST_F(EvalApp, PlacingLabelsWithTheTruthCountsCameraErrorToo) {
    const std::vector<std::string> arguments{"--trajectory", estimateFile_, "--truth",
                                             truthFile_,     "--objects",   objectsFile_,
                                             "--labels",     labelsFile_,   "--json"};
    auto withTruth = arguments;
    withTruth.push_back("--world-from-truth");
    const auto own = nlohmann::json::parse(runApp(arguments));
    const auto absolute = nlohmann::json::parse(runApp(withTruth));
    EXPECT_LT(own["bev_error_median_m"].get<double>(), 0.01);
    EXPECT_NEAR(absolute["bev_error_median_m"].get<double>(), 0.15, 0.01);
}

TEST_F(EvalApp, TableShowsTheSameFigures) {
    const auto text = runApp({"--trajectory", estimateFile_, "--truth", truthFile_, "--objects",
                              objectsFile_, "--labels", labelsFile_, "--range", "0:12"});
    for (const std::string piece :
         {"12 frames", "ATE, SE(3)-aligned", "shorter than 100 m", "matched one to one", "Car"}) {
        EXPECT_THAT(text, HasSubstr(piece));
    }
}

TEST_F(EvalApp, SelectionsByMotionRangeAndClass) {
    const auto labelled = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--trajectory", estimateFile_, "--truth",
                                           truthFile_,     "--json",      "--objects",
                                           objectsFile_,   "--labels",    labelsFile_};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return nlohmann::json::parse(runApp(arguments))["objects_labelled"].get<int>();
    };
    EXPECT_EQ(labelled({"--static-only"}), 1);
    EXPECT_EQ(labelled({"--moving-only"}), 0);
    EXPECT_EQ(labelled({"--moving-only", "--static-below", "0.2"}), 1)
        << "labels follow the estimate";
    EXPECT_EQ(labelled({"--max-range", "5"}), 0);
    EXPECT_EQ(labelled({"--max-range", "50"}), 1);
    EXPECT_EQ(labelled({"--classes", "Van,Truck"}), 0);
    EXPECT_EQ(labelled({"--classes", "car"}), 1);
}

TEST_F(EvalApp, RefusesCommandLinesThatMakeNoSense) {
    EXPECT_INPUT_ERROR(runApp({}), "command line", "required");
    EXPECT_INPUT_ERROR(runApp({"--nonsense"}), "command line", "--nonsense");
    EXPECT_INPUT_ERROR(runApp({"--trajectory", "a"}), "--truth");
    const std::vector<std::string> good{"--trajectory", estimateFile_, "--truth", truthFile_};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), good.begin(), good.end());
        return runApp(more);
    };
    EXPECT_INPUT_ERROR(with({"--objects", "o"}), "--labels");
    EXPECT_INPUT_ERROR(with({"--labels", "l"}), "--objects");
    EXPECT_INPUT_ERROR(with({"--static-only", "--moving-only"}), "exclude");
    EXPECT_INPUT_ERROR(with({"--max-range", "-3"}), "--max-range");
    EXPECT_INPUT_ERROR(with({"--static-below", "0"}), "--static-below");
    EXPECT_INPUT_ERROR(with({"--revisit-gap", "0"}), "--revisit-gap");
    EXPECT_INPUT_ERROR(with({"--max-range", "far"}), "max-range");
    EXPECT_INPUT_ERROR(with({"--classes", "Car,Tank"}), "Tank");
    EXPECT_INPUT_ERROR(with({"--range", "7"}), "A:B");
    EXPECT_INPUT_ERROR(with({"--range", "0:13"}), "truth.txt", "12 poses");
    const std::vector<std::string> objects{"--trajectory", estimateFile_, "--objects",
                                           objectsFile_,   "--labels",    labelsFile_};
    for (const std::string option : {"--static-only", "--moving-only", "--world-from-truth"}) {
        auto arguments = objects;
        arguments.push_back(option);
        EXPECT_INPUT_ERROR(runApp(arguments), option, "--truth");
    }
}

TEST_F(EvalApp, NamesTheFileThatIsMissing) {
    EXPECT_INPUT_ERROR(runApp({"--trajectory", "no/such.txt", "--truth", truthFile_}),
                       "no/such.txt");
    EXPECT_INPUT_ERROR(runApp({"--trajectory", estimateFile_, "--truth", "no/poses.txt"}),
                       "no/poses.txt");
    EXPECT_INPUT_ERROR(runApp({"--trajectory", estimateFile_, "--objects", "no/objects.csv",
                               "--labels", labelsFile_}),
                       "no/objects.csv");
    EXPECT_INPUT_ERROR(runApp({"--trajectory", estimateFile_, "--objects", objectsFile_, "--labels",
                               "no/labels.txt"}),
                       "no/labels.txt");
}

TEST(EvalAppRealData, LabelsOfTracking0000AsObjectsMatchThemselves) {
    DJPETE_SHARED_OR_SKIP(data, "data");
    const std::string cameras = data / "trajectories/kitti_tracking_0000_orbslam3_stereo.txt";
    const std::string labels = data / "kitti/tracking/training/label_02/0000.txt";
    const SE3 T_world_firstcam = djpete::geometry::opticalToVehicleAxes();
    const auto path = readTrajectory(cameras);
    std::string csv = csvPreamble(0, T_world_firstcam);
    std::set<int64_t> vehicles;
    for (const auto& box : readTrackingLabels(labels)) {
        if (!djpete::obs::isVehicle(box.objectClass)) continue;
        vehicles.insert(box.trackId);
        csv += csvRow(static_cast<int>(box.trackId), toString(box.objectClass), box.frame,
                      T_world_firstcam * path.poses.at(box.frame) * box.T_cam_obj);
    }
    const auto file = writeText(djpete_test::scratch("eval_real") / "objects.csv", csv);
    const auto j = nlohmann::json::parse(runApp({"--trajectory", cameras, "--truth", cameras,
                                                 "--objects", file, "--labels", labels, "--json"}));
    EXPECT_GT(j["objects_labelled"], 5);
    EXPECT_LE(j["objects_labelled"], vehicles.size());
    EXPECT_EQ(j["objects_matched_one_to_one"], j["objects_labelled"]);
    EXPECT_EQ(j["objects_false"], 0);
    EXPECT_LT(j["centre_error_p90_m"], 1e-9);
    EXPECT_LT(j["yaw_error_median_deg"], 1e-5);
}
