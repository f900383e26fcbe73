/// Every kind of bad input gets one sentence that names its place.
#include <gmock/gmock.h>

#include "made_up_drive.h"

namespace fs = std::filesystem;
using made_up::drive;
using made_up::refusal;
using made_up::writeText;
using testing::AllOf;
using testing::HasSubstr;

namespace {

std::string convertError(const fs::path& dir, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"--input", dir.string(), "--out", (dir / "d.rawlog").string()};
    words.insert(words.end(), more.begin(), more.end());
    return refusal(words);
}

}  // namespace

TEST(BadInput, FoldersThatAreMissingOrNoDrive) {
    const auto dir = djpete_test::scratch("bad_folder");
    EXPECT_THAT(convertError(dir / "absent"), HasSubstr("absent: no such folder"));
    EXPECT_THAT(convertError(dir), HasSubstr("no KITTI drive"));
    writeText(dir / "file.txt", "x");
    EXPECT_THAT(convertError(dir / "file.txt"), HasSubstr("not a folder"));
    EXPECT_THAT(convertError(dir, {"--sequence", "0042"}), HasSubstr("no tracking sequence 0042"));
    writeText(dir / "calib" / "0006.txt", made_up::kCalib);
    fs::create_directories(dir / "label_02");
    EXPECT_THAT(convertError(dir), HasSubstr("--sequence"));
}

TEST(BadInput, CommandLines) {
    const auto dir = drive("bad_command");
    EXPECT_THAT(refusal({"--input", dir.string()}), HasSubstr("required"));
    EXPECT_THAT(convertError(dir, {"--frobnicate"}), HasSubstr("--frobnicate"));
    EXPECT_THAT(convertError(dir, {"--range", "5:2"}), HasSubstr("A < B"));
    EXPECT_THAT(convertError(dir, {"--range", "50:60"}), HasSubstr("frames 0 to 3"));
    EXPECT_THAT(convertError(dir, {"--labels", "absent.txt"}), HasSubstr("absent.txt"));
    EXPECT_THAT(convertError(dir, {"--detection-sigma-m", "0"}), HasSubstr("positive"));
    EXPECT_THAT(convertError(dir, {"--detection-sigma-m", "much"}), HasSubstr("detection-sigma-m"));
    EXPECT_THAT(refusal({"--input", dir.string(), "--out", dir.string()}),
                HasSubstr("cannot be written"));
}

TEST(BadInput, Calibration) {
    const auto dir = drive("bad_calib");
    const std::string good = made_up::kCalib;
    const auto error = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        writeText(dir / "calib.txt", text);
        return convertError(dir);
    };
    EXPECT_THAT(error("P1: 20 0 16 -10", "P1: 20 0 16"),
                AllOf(HasSubstr("calib.txt:2"), HasSubstr("12 columns; expected 13")));
    EXPECT_THAT(error("P0: 20", "P0: twenty"),
                AllOf(HasSubstr("calib.txt:1"), HasSubstr("twenty")));
    EXPECT_THAT(error("P0: 20", "P0: -20"), HasSubstr("positive focal lengths"));
    EXPECT_THAT(error("-10", "+10"), HasSubstr("no rectified pair"));
    EXPECT_THAT(error("P1:", "Q1:"), HasSubstr("camera 1"));
    EXPECT_THAT(error("Tr:", "Xr:"), HasSubstr("Velodyne"));
    EXPECT_THAT(error("Tr: 0 -1", "Tr: 0 -2"), HasSubstr("no rotation"));
    EXPECT_THAT(error(good, "hello world\n"), HasSubstr("no camera calibration"));
    fs::remove(dir / "calib.txt");
    EXPECT_THAT(convertError(dir), HasSubstr("calib.txt: no such file"));
}

TEST(BadInput, Times) {
    const auto dir = drive("bad_times");
    const auto times = [&](const std::string& text) {
        writeText(dir / "times.txt", text);
        return convertError(dir);
    };
    EXPECT_THAT(times("0\n0.1\n"), AllOf(HasSubstr("times.txt: 2 times"), HasSubstr("frame 3")));
    EXPECT_THAT(times("0\n0.1\n0.1\n0.2\n"),
                AllOf(HasSubstr("times.txt:3"), HasSubstr("increase")));
    EXPECT_THAT(times("0\n0.1\nnan\n0.2\n"), HasSubstr("times.txt:3"));
    EXPECT_THAT(times("2011-09-26 13:04\n"), HasSubstr("is no time"));
    fs::remove(dir / "times.txt");
    EXPECT_THAT(convertError(dir), HasSubstr("no times.txt"));
}

TEST(BadInput, Poses) {
    const auto dir = drive("bad_poses");
    const auto poses = [&](const std::string& text) {
        writeText(dir / "poses.txt", text);
        return convertError(dir);
    };
    const std::string row = "1 0 0 0 0 1 0 0 0 0 1 0\n";
    EXPECT_THAT(poses(row + "1 0 0 0 0 1 0 0 0 0 1\n"),
                AllOf(HasSubstr("poses.txt:2"), HasSubstr("11 columns; expected 12")));
    EXPECT_THAT(poses(row + row + "1 0 0 nan 0 1 0 0 0 0 1 0\n"), HasSubstr("poses.txt:3: 'nan'"));
    EXPECT_THAT(poses("1 0 0 0 0 2 0 0 0 0 1 0\n"), HasSubstr("no rotation"));
    EXPECT_THAT(poses("\n"), HasSubstr("empty"));
    writeText(dir / "poses.txt", row);
    EXPECT_THAT(convertError(dir, {"--range", "2:4"}), HasSubstr("frame 2"));
}

TEST(BadInput, ImagesAndScansKeepWhatCameBefore) {
    const auto check = [](const char* name, auto spoil, auto matches) {
        const auto dir = drive(name);
        spoil(dir);
        EXPECT_THAT(convertError(dir), matches);
        // Frames 0 and 1 were written, and the rawlog says that more were to come.
        djpete::obs::RawlogSource source(dir / "d.rawlog");
        EXPECT_TRUE(source.next());
        EXPECT_TRUE(source.next());
        EXPECT_ANY_THROW(while (source.next()){});
    };
    check(
        "bad_size", [](auto d) { made_up::writePng(d / "image_1" / "000002.png", 30, 16); },
        AllOf(HasSubstr("image_1/000002.png"), HasSubstr("30x16 but 32x16")));
    check(
        "bad_png", [](auto d) { writeText(d / "image_0" / "000002.png", "\x89PNG"); },
        HasSubstr("image_0/000002.png: cannot be read as an image"));
    check(
        "bad_bin", [](auto d) { made_up::writeScan(d / "velodyne" / "000002.bin", 35); },
        AllOf(HasSubstr("000002.bin"), HasSubstr("35 bytes")));
    check(
        "empty_bin", [](auto d) { made_up::writeScan(d / "velodyne" / "000002.bin", 0); },
        HasSubstr("0 bytes"));
}

TEST(BadInput, InstanceMasks) {
    const auto dir = drive("bad_masks");
    writeText(dir / "label_02.txt", "1 7 Car 0 0 0 4 4 12 12 1.5 1.6 4 0 1 10 0\n");
    made_up::writePng(dir / "instances" / "000001.png");  // 8 bit
    EXPECT_THAT(convertError(dir), AllOf(HasSubstr("instances/000001.png"), HasSubstr("16-bit")));
}

TEST(BadInput, NothingToConvert) {
    const auto dir = drive("bad_nothing");
    for (const char* f : {"image_0", "image_1", "velodyne", "poses.txt"}) fs::remove_all(dir / f);
    EXPECT_THAT(convertError(dir), HasSubstr("--poses"));
}
