/// A broken run ends with the bytes of an unbroken one.
#include <gmock/gmock.h>

#include "small_drive.h"

using namespace small_drive;
using testing::HasSubstr;

namespace {

using Words = std::vector<std::string>;

Words tiny(const fs::path& out, const Words& more = {}) {
    Words words{"--out",  out.string(), "--frames", "1:4", "--size",  "124x38",
                "--seed", "4",          "--depth",  "2:3", "--fault", "time-jump"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string refusal(const Words& words) {
    try {
        simulate(words);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "(accepted)";
}

void expectSame(const fs::path& a, const fs::path& b) {
    const auto filesA = filesOf(a), filesB = filesOf(b);
    ASSERT_EQ(filesA.size(), filesB.size());
    for (const auto& [name, bytes] : filesA) {
        ASSERT_EQ(filesB.count(name), 1U) << name;
        EXPECT_TRUE(filesB.at(name) == bytes) << name;
    }
}

/// Stops the program after so many frames have been rendered.
void breakAfter(uint64_t frames, const fs::path& dir) {
    const auto words = tiny(dir);
    std::vector<const char*> argv{"simulate-drive"};
    for (const auto& w : words) argv.push_back(w.c_str());
    djpete::apps::SimulateDriveApp app;
    ASSERT_TRUE(app.initialize(static_cast<int>(argv.size()), argv.data()));
    EXPECT_THROW(sim::writeDrive(app.options, dir,
                                 [&](uint64_t done, uint64_t) {
                                     if (done == frames) throw std::runtime_error("power cut");
                                 }),
                 std::runtime_error);
}

}  // namespace

TEST(SimulatedResume, EndsWithTheBytesOfAnUnbrokenRun) {
    const auto whole = djpete_test::scratch("sim_unbroken");
    simulate(tiny(whole));
    const auto dir = djpete_test::scratch("sim_broken");
    breakAfter(2, dir);
    EXPECT_FALSE(fs::exists(dir / "label_02.txt"));
    EXPECT_TRUE(fs::exists(dir / "unfinished"));
    simulate(tiny(dir, {"--resume"}));
    expectSame(whole, dir);
}

TEST(SimulatedResume, KeepsWholeFramesAndMakesTornOnesAgain) {
    const auto dir = djpete_test::scratch("sim_torn");
    simulate(tiny(dir));
    const auto before = filesOf(dir);
    // Old enough to tell whether a file has been written again.
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (const auto& e : fs::recursive_directory_iterator(dir)) {
        if (e.is_regular_file()) fs::last_write_time(e.path(), old);
    }
    fs::resize_file(dir / "image_1" / "000002.png", 700);  // no end
    fs::remove(dir / "velodyne" / "000003.bin");
    simulate(tiny(dir, {"--resume"}));
    EXPECT_EQ(filesOf(dir), before);
    const auto isNew = [&](const char* file) { return fs::last_write_time(dir / file) > old; };
    EXPECT_FALSE(isNew("image_0/000001.png"));
    EXPECT_FALSE(isNew("velodyne/000001.bin"));
    EXPECT_TRUE(isNew("image_0/000002.png"));
    EXPECT_TRUE(isNew("velodyne/000003.bin"));
}

TEST(SimulatedResume, RefusesOtherOptionsInOneSentence) {
    const auto dir = djpete_test::scratch("sim_other_options");
    breakAfter(1, dir);
    const auto words = tiny(dir, {"--resume", "--step", "0.7"});
    EXPECT_THAT(refusal(words), HasSubstr("drive_options.txt: the drive was begun with 'step 0.8', "
                                          "not 'step 0.7'"));
    // Threads have no say in the bytes.
    EXPECT_EQ(refusal(tiny(dir, {"--resume", "--threads", "3"})), "(accepted)");
}

TEST(SimulatedResume, RefusesAnotherWay) {
    const auto dir = djpete_test::scratch("sim_other_way");
    sim::DriveOptions options;
    options.begin = 0, options.end = 1;
    options.world.frames = 1;
    options.width_px = 64, options.height_px = 32;
    options.scans = options.colour = false;
    sim::writeDrive(options, dir, nullptr);
    options.resume = true;
    options.world.route = sim::RouteKind::Blocks;
    const auto message = [&] {
        try {
            sim::writeDrive(options, dir, nullptr);
        } catch (const std::runtime_error& e) {
            return std::string(e.what());
        }
        return std::string("(accepted)");
    };
    EXPECT_THAT(message(), HasSubstr("begun with 'route street', not 'route blocks'"));
    options.world.T_first_cam = {SE3(), SE3()};
    EXPECT_THAT(message(), HasSubstr("not 'route poses 2"));
}

TEST(SimulatedResume, StartsAnewWhereNothingWasBegun) {
    const auto dir = djpete_test::scratch("sim_nothing_begun");
    simulate(tiny(dir, {"--resume", "--no-scans", "--no-color"}));
    EXPECT_TRUE(fs::exists(dir / "image_0" / "000003.png"));
    EXPECT_FALSE(fs::exists(dir / "image_2"));
    EXPECT_FALSE(fs::exists(dir / "unfinished"));
}
