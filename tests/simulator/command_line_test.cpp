/// Bad arguments get one sentence that says what was expected.
#include <gmock/gmock.h>

#include "djpete/obs/errors.h"
#include "small_drive.h"

using testing::HasSubstr;
using testing::Not;

namespace {

namespace fs = std::filesystem;

/// What the program says when it refuses these words.
template <class Error = djpete::obs::InputError>
std::string refusal(const std::vector<std::string>& words) {
    try {
        small_drive::simulate(words);
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
        return e.what();
    }
    return "(accepted)";
}

std::string refusedOption(const std::string& option, const std::string& value) {
    return refusal({"--out", "never_made", "--" + option, value});
}

}  // namespace

TEST(SimulateDriveCommandLine, UnknownOrMissingOptions) {
    EXPECT_THAT(refusal({"--out", "never_made", "--frobnicate"}), HasSubstr("--frobnicate"));
    EXPECT_THAT(refusal({"--frames", "0:2"}), HasSubstr("required"));
    EXPECT_FALSE(fs::exists("never_made"));
}

TEST(SimulateDriveCommandLine, FrameRanges) {
    EXPECT_THAT(refusedOption("frames", "5:2"), HasSubstr("A < B"));
    EXPECT_THAT(refusedOption("frames", "x:2"), HasSubstr("x:2"));
    EXPECT_THAT(refusedOption("frames", "0:"), HasSubstr("at most 1000000"));
}

TEST(SimulateDriveCommandLine, SizesAndNumbers) {
    for (const char* bad : {"big", "310", "310x", "310x94x3", "0x94", "310x-94", "9000x94"}) {
        EXPECT_THAT(refusedOption("size", bad), HasSubstr("--size " + std::string(bad))) << bad;
    }
    EXPECT_THAT(refusedOption("step", "0"), HasSubstr("--step 0: expected 0.05 to 5"));
    EXPECT_THAT(refusedOption("step", "nan"), HasSubstr("step"));
    EXPECT_THAT(refusedOption("convoy", "0.6"), HasSubstr("--convoy 0.6: expected 0 to 0.5"));
    EXPECT_THAT(refusedOption("lane-offset", "2"), HasSubstr("--lane-offset 2: expected -0.5 to"));
    EXPECT_THAT(refusedOption("traffic-seed", "-1"), HasSubstr("--traffic-seed -1: expected 0"));
    EXPECT_THAT(refusedOption("sun-deg", "400"), HasSubstr("--sun-deg 400: expected -360 to 360"));
    EXPECT_THAT(refusedOption("threads", "-1"), HasSubstr("threads"));
    EXPECT_THAT(refusedOption("seed", "first"), HasSubstr("seed"));
    EXPECT_THAT(refusedOption("detection-sigma-m", "-0.1"), HasSubstr("expected 0 to 10"));
    EXPECT_THAT(refusedOption("detection-miss", "1.5"), HasSubstr("expected 0 to 1"));
    EXPECT_THAT(refusedOption("detection-false", "1"), HasSubstr("expected 0 to 0.9"));
    EXPECT_THAT(refusedOption("fog", "5"), HasSubstr("--fog 5: expected 10 to 10000"));
}

TEST(SimulateDriveCommandLine, FoldersThatCannotBeWritten) {
    const auto dir = djpete_test::scratch("sim_unwritable");
    std::ofstream(dir / "file") << "x";
    const std::vector<std::string> tiny{"--frames", "0:1", "--size", "64x32", "--no-scans"};
    const auto with = [&](const fs::path& out) {
        auto words = tiny;
        words.insert(words.end(), {"--out", out.string()});
        return words;
    };
    EXPECT_THAT(refusal<std::runtime_error>(with(dir / "file")), HasSubstr("cannot be made"));
    // A file where one of the folders should be.
    std::ofstream(dir / "image_1") << "x";
    EXPECT_THAT(refusal<std::runtime_error>(with(dir)), HasSubstr("image_1"));
    // A folder where a picture or a table should be.
    fs::create_directories(dir / "drive" / "image_2" / "000000.png");
    EXPECT_THAT(refusal<std::runtime_error>(with(dir / "drive")), HasSubstr("000000.png"));
    fs::create_directories(dir / "other" / "poses.txt");
    EXPECT_THAT(refusal<std::runtime_error>(with(dir / "other")), HasSubstr("poses.txt"));
}

TEST(SimulateDriveCommandLine, Ways) {
    EXPECT_THAT(refusedOption("route", "circle"), HasSubstr("expected street or blocks"));
    EXPECT_THAT(refusedOption("poses", "no_such_poses.txt"), HasSubstr("no_such_poses.txt"));
    EXPECT_THAT(refusedOption("meshes", "0"), HasSubstr("--meshes 0: expected 0.002 to 1"));
    const auto file = djpete_test::scratch("sim_ways") / "poses.txt";
    std::ofstream(file) << "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n";
    EXPECT_THAT(refusal({"--out", "never_made", "--poses", file.string(), "--route", "blocks"}),
                HasSubstr("one of them at most"));
    EXPECT_THAT(refusal({"--out", "never_made", "--poses", file.string(), "--frames", "0:3"}),
                HasSubstr("an end of at most 2"));
    std::ofstream(file) << "1 0 0 0 0 1 0 0 0 0 1\n";
    EXPECT_THAT(refusal({"--out", "never_made", "--poses", file.string()}), HasSubstr("poses.txt"));
    EXPECT_FALSE(fs::exists("never_made"));
}
