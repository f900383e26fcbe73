/// Real KITTI drives through the programs, on the figures that docs/RESULTS.md states.
#include <gtest/gtest.h>

#include <sstream>

#include "djpete_eval_app.h"
#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

fs::path rawlogOf(const std::string& name, const std::vector<std::string>& arguments) {
    const auto rawlog = scratch("real_" + name) / (name + ".rawlog");
    std::vector<std::string> all{"--out", rawlog.string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto outcome = convert(all);
    EXPECT_EQ(outcome.code, 0) << outcome.sentence;
    return rawlog;
}

std::string config(const std::string& name) {
    return std::string(DJPETE_SOURCE_DIR) + "/datasets_cfg/" + name;
}

djpete::evaluation::TrajectoryErrors ateOf(const fs::path& estimate, const fs::path& truth,
                                           const std::string& range) {
    const std::string e = (estimate / "trajectory.kitti.txt").string(), t = truth.string();
    const char* argv[] = {"djpete-eval", "--trajectory", e.c_str(),    "--truth",
                          t.c_str(),     "--range",      range.c_str()};
    djpete::apps::DjpeteEvalApp app;
    EXPECT_TRUE(app.initialize(7, argv));
    std::ostringstream out;
    app.run(out);
    return *app.results.trajectory;
}

TEST(RealData, Odometry00HundredStereoPairs) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti/odometry");
    const auto rawlog = rawlogOf("00", {"--input", (kitti / "sequences/00").string()});
    const auto out = rawlog.parent_path() / "result";
    djpete::apps::DjpeteSlamApp app;
    const auto outcome =
        slam(app, {rawlog.string(), "--out", out.string()}, config("kitti_odometry.ini"));
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    EXPECT_EQ(app.summary.tracked, 100U);
    EXPECT_LE(ateOf(out, kitti / "poses/00.txt", "0:100").ate_se3_m, 0.47);
    EXPECT_GE(app.summary.texturedObjects, 3U);  // parked cars, where scans exist
}

TEST(RealData, Odometry02TwentyColourPairs) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti/odometry");
    const auto rawlog = rawlogOf("02", {"--input", (kitti / "sequences/02").string()});
    const auto out = rawlog.parent_path() / "result";
    djpete::apps::DjpeteSlamApp app;
    const auto outcome =
        slam(app, {rawlog.string(), "--out", out.string()}, config("kitti_odometry.ini"));
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    EXPECT_EQ(app.summary.tracked, 20U);
    EXPECT_LE(ateOf(out, kitti / "poses/02.txt", "0:20").ate_se3_m, 0.15);
}

/// Raw drive 0005, frames 0-24: one camera and the Velodyne.
class Drive0005 : public testing::Test {
  protected:
    djpete::evaluation::ObjectErrors run(const std::string& name, bool labelsAsDetections,
                                         const fs::path& shared) {
        const auto labels = shared / "tracking/training/label_02/0000.txt";
        const auto rawlog = rawlogOf(
            name, {"--input", (shared / "raw/2011_09_26/2011_09_26_drive_0005_sync").string(),
                   "--labels", labelsAsDetections ? labels.string() : "none"});
        const auto out = rawlog.parent_path() / "result";
        const auto outcome =
            slam(app_, {rawlog.string(), "--out", out.string()}, config("kitti_raw.ini"));
        EXPECT_EQ(outcome.code, 0) << outcome.sentence;
        const auto reference =
            shared.parent_path() / "trajectories/kitti_tracking_0000_orbslam3_stereo.txt";
        ate_ = ateOf(out, reference, "0:25").ate_se3_m;
        const std::string t = (out / "trajectory.kitti.txt").string(),
                          o = (out / "objects.csv").string(), l = labels.string();
        const char* argv[] = {"djpete-eval", "--trajectory", t.c_str(),
                              "--objects",   o.c_str(),      "--labels",
                              l.c_str(),     "--max-range",  name == "0005" ? "200" : "25"};
        djpete::apps::DjpeteEvalApp eval;
        EXPECT_TRUE(eval.initialize(9, argv));
        std::ostringstream text;
        eval.run(text);
        text_ = text.str();
        return *eval.results.objects;
    }
    djpete::apps::DjpeteSlamApp app_;
    double ate_ = 0;
    std::string text_;
};

TEST_F(Drive0005, LabelsBecomeOneObjectEach) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti");
    const auto errors = run("0005", true, kitti);
    EXPECT_LE(ate_, 0.25);
    EXPECT_EQ(errors.duplicated, 0U) << text_;
    EXPECT_EQ(errors.missed, 0U) << text_;
    EXPECT_EQ(errors.matchedOneToOne, errors.labelled) << text_;
    EXPECT_GE(errors.labelled, 2U);
    EXPECT_LE(errors.centre_m.median, 0.20) << text_;
}

TEST_F(Drive0005, GeometricObserverFindsCars) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti");
    const auto errors = run("0005g", false, kitti);
    EXPECT_LE(ate_, 0.25);
    EXPECT_GE(double(errors.matchedOneToOne), 0.6 * double(errors.labelled)) << text_;
}

}  // namespace
}  // namespace djpete_test
