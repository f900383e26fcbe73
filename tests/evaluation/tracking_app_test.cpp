/// djpete-eval --tracking.
#include <nlohmann/json.hpp>

#include "djpete_eval_app.h"
#include "evaluation_worlds.h"

using namespace evaluation_test;
using djpete::apps::DjpeteEvalApp;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

std::string runApp(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"djpete-eval"};
    for (const auto& a : arguments) argv.push_back(a.c_str());
    DjpeteEvalApp app;
    std::ostringstream out;
    if (app.initialize(static_cast<int>(argv.size()), argv.data())) app.run(out);
    return out.str();
}

nlohmann::json jsonOf(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    return nlohmann::json::parse(runApp(arguments));
}

/// A car in ten frames, `shift_m` to the right and `lift_m` up.
std::string rows(double shift_m, double lift_m, const std::string& score, int id = 3) {
    std::ostringstream out;
    for (int f = 0; f < 10; ++f) {
        out << f << " " << id << " Car 0 0 0 0 0 100 100 1.5 2 4 " << shift_m << " " << 1.6 - lift_m
            << " 10 0 " << score << "\n";
    }
    return out.str();
}

/// Labels 0000, 0006, 0010; results of the first two: one perfect, one 2 m off.
class TrackingApp : public ::testing::Test {
  protected:
    TrackingApp() {
        std::filesystem::create_directories(dir_ / "labels");
        std::filesystem::create_directories(dir_ / "results");
        for (const std::string name : {"0000", "0006", "0010"}) {
            writeText(dir_ / "labels" / (name + ".txt"), rows(0, 0, ""));
        }
        writeText(dir_ / "results/0000.txt", rows(0, 0, "0.5"));
        writeText(dir_ / "results/0006.txt", rows(2, 0, "0.5"));
    }
    std::string label(const std::string& name) const { return dir_ / "labels" / name; }
    std::string result(const std::string& name) const { return dir_ / "results" / name; }

    const std::filesystem::path dir_ = djpete_test::scratch("tracking_app");
    const std::string labels_ = dir_ / "labels", results_ = dir_ / "results";
};

}  // namespace

TEST_F(TrackingApp, JsonOfAFolder) {
    // 0006 is 2 m off, overlap 1/3: matched at 0.25, at 0.5 ten misses and ten false of 20 labels.
    const auto j = jsonOf({"--tracking", results_, "--labels", labels_});
    EXPECT_DOUBLE_EQ(j["mota25"], 1);
    EXPECT_DOUBLE_EQ(j["mota50"], 0);
    EXPECT_NEAR(j["motp"].get<double>(), 2.0 / 3, 1e-12);
    for (const char* key : {"ids", "frag", "fp", "fn"}) EXPECT_EQ(j[key], 0) << key;
    EXPECT_EQ(j["labels"], 20);
    EXPECT_NEAR(j["samota"].get<double>(), 19.0 / 40, 1e-12);
    for (const char* key : {"hota", "deta", "assa", "loca"}) {
        EXPECT_GT(j[key], 0) << key;
        EXPECT_LT(j[key], 1) << key;
    }
    ASSERT_EQ(j["sequences"].size(), 2U) << "labels in a folder without a result are left out";
    EXPECT_EQ(j["sequences"][1]["name"], "0006");
    EXPECT_DOUBLE_EQ(j["sequences"][0]["mota50"], 1);
    EXPECT_DOUBLE_EQ(j["sequences"][1]["mota50"], -1);
    EXPECT_DOUBLE_EQ(j["sequences"][1]["own_mota25"], 1);
}

TEST_F(TrackingApp, FilesByNameArePairedInOrder) {
    const auto other = writeText(dir_ / "mine.txt", rows(0, 0, "0.5"));
    EXPECT_DOUBLE_EQ(jsonOf({"--tracking", other, "--labels", label("0010.txt")})["mota50"], 1);
    const auto two = jsonOf({"--tracking", result("0006.txt"), result("0000.txt"), "--labels",
                             label("0006.txt"), label("0000.txt")});
    EXPECT_EQ(two["sequences"][0]["name"], "0006");
    EXPECT_DOUBLE_EQ(two["sequences"][1]["mota50"], 1);
}

TEST_F(TrackingApp, AFileMeetsItsLabelsInAFolder) {
    const auto j = jsonOf({"--tracking", result("0006.txt"), "--labels", labels_});
    ASSERT_EQ(j["sequences"].size(), 1U);
    EXPECT_EQ(j["sequences"][0]["name"], "0006");
}

TEST_F(TrackingApp, BirdsEyeIgnoresHeights) {
    const auto high = writeText(dir_ / "high.txt", rows(0, 5, "0.5"));
    const std::vector<std::string> arguments{"--tracking", high, "--labels", label("0000.txt")};
    auto fromAbove = arguments;
    fromAbove.push_back("--bev");
    EXPECT_DOUBLE_EQ(jsonOf(arguments)["mota25"], -1);
    EXPECT_DOUBLE_EQ(jsonOf(fromAbove)["mota25"], 1);
}

TEST_F(TrackingApp, ARangeOfFrames) {
    const auto j =
        jsonOf({"--tracking", result("0000.txt"), "--labels", labels_, "--range", "2:6"});
    EXPECT_EQ(j["labels"], 4);
    EXPECT_DOUBLE_EQ(j["mota25"], 1);
}

TEST_F(TrackingApp, TableShowsTheFigures) {
    const auto text = runApp({"--tracking", results_, "--labels", labels_});
    for (const std::string piece : {"MOTA@0.25", "sAMOTA", "HOTA", "0006", "all", "47.50"}) {
        EXPECT_THAT(text, HasSubstr(piece));
    }
    EXPECT_THAT(text, Not(HasSubstr("0010")));
}

TEST_F(TrackingApp, AnEmptyResultMissesAll) {
    const auto none = writeText(dir_ / "0000.txt", "");
    const auto j = jsonOf({"--tracking", none, "--labels", label("0000.txt")});
    EXPECT_EQ(j["fn"], 10);
    EXPECT_TRUE(j["motp"].is_null());
}

TEST_F(TrackingApp, RefusesWhatMakesNoSense) {
    EXPECT_INPUT_ERROR(runApp({"--tracking", results_}), "--labels");
    EXPECT_INPUT_ERROR(runApp({"--tracking", results_, "--labels", labels_, "--truth", "t"}),
                       "--tracking");
    EXPECT_INPUT_ERROR(runApp({"--trajectory", "t", "--truth", "t", "--bev"}), "--bev");
    EXPECT_INPUT_ERROR(runApp({"--tracking", "no/such", "--labels", labels_}), "no/such");
    EXPECT_INPUT_ERROR(runApp({"--tracking", results_, "--labels", label("0000.txt")}), "0006.txt",
                       "expected labels");
    EXPECT_INPUT_ERROR(runApp({"--tracking", result("0000.txt"), "--labels", label("0000.txt"),
                               label("0006.txt")}),
                       "0006.txt", "expected a result");
    EXPECT_INPUT_ERROR(runApp({"--tracking", results_, result("0000.txt"), "--labels", labels_}),
                       "0000.txt", "twice");
    EXPECT_INPUT_ERROR(runApp({"--tracking", dir_, "--labels", labels_}), "expected files");
    EXPECT_INPUT_ERROR(runApp({"--tracking", labels_, "--labels", results_}), "expected labels");
}
