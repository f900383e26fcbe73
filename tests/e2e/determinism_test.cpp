/// Same drive, same bytes: lockstep or threaded, objects on or off.
#include <gtest/gtest.h>

#include <fstream>

#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

fs::path run(const fs::path& rawlog, const std::string& name, std::vector<std::string> arguments) {
    const auto out = rawlog.parent_path() / name;
    arguments.insert(arguments.begin(), {rawlog.string(), "--out", out.string()});
    djpete::apps::DjpeteSlamApp app;
    const auto outcome = slam(app, arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.sentence;
    return out;
}

class Determinism : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        rawlog_ = scratch("e2e_determinism") / "drive.rawlog";
        ASSERT_EQ(convert({"--input", smallDrive().string(), "--out", rawlog_.string(), "--labels",
                           "none", "--detections", (smallDrive() / "detections.txt").string()})
                      .code,
                  0);
    }
    static fs::path rawlog_;
};
fs::path Determinism::rawlog_;

void expectEqualFolders(const fs::path& a, const fs::path& b) {
    std::size_t compared = 0;
    for (const auto& entry : fs::recursive_directory_iterator(a)) {
        if (!entry.is_regular_file() || entry.path().filename() == "summary.json") continue;
        const auto relative = fs::relative(entry.path(), a);
        EXPECT_TRUE(textOf(entry.path()) == textOf(b / relative)) << relative;
        ++compared;
    }
    EXPECT_GE(compared, 8U);
}

TEST_F(Determinism, LockstepAndThreadedGiveTheSameBytes) {
    const auto lockstep = run(rawlog_, "lockstep", {"--mode", "lockstep"});
    expectEqualFolders(lockstep, run(rawlog_, "threaded", {"--mode", "threaded"}));
    expectEqualFolders(lockstep, run(rawlog_, "again", {"--mode", "threaded"}));
}

TEST_F(Determinism, TenRunsWithOneTwoAndFourThreadsGiveTheSameBytes) {
    const auto first = run(rawlog_, "threads_first", {"--threads", "1"});
    for (int i = 0; i < 9; ++i) {
        const std::string threads = std::to_string(1 << (i % 3));
        const auto name = "threads_" + std::to_string(i);
        expectEqualFolders(first, run(rawlog_, name, {"--threads", threads}));
    }
}

TEST_F(Determinism, ObjectsDoNotMoveTheCamera) {
    // The object worker on or off, with the same features kept off the objects.
    const auto ini = rawlog_.parent_path() / "no_objects.ini";
    std::ofstream(ini) << textOf(fs::path(DJPETE_SOURCE_DIR) / "datasets_cfg" / "simulated.ini")
                       << "\n[objects]\nmode = off\n";
    const auto with = run(rawlog_, "with_objects", {});
    djpete::apps::DjpeteSlamApp app;
    const auto out = rawlog_.parent_path() / "without_objects";
    const auto outcome = slam(app, {rawlog_.string(), "--out", out.string()}, ini.string());
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    EXPECT_EQ(app.summary.objects, 0U);
    EXPECT_TRUE(textOf(with / "trajectory.kitti.txt") == textOf(out / "trajectory.kitti.txt"));
    EXPECT_TRUE(textOf(with / "trajectory.tum") == textOf(out / "trajectory.tum"));
}

}  // namespace
}  // namespace djpete_test
