/// Bad input gets one sentence that names the place, an exit code that is not 0, and loses nothing
/// that was computed before it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// One sentence: one line, not empty.
void expectSentence(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.sentence, Not(testing::IsEmpty()));
    EXPECT_THAT(outcome.sentence, Not(HasSubstr("\n")));
    for (const auto& w : words) EXPECT_THAT(outcome.sentence, HasSubstr(w));
}

void cutFile(const fs::path& file, double share) {
    const auto bytes = static_cast<double>(fs::file_size(file));
    fs::resize_file(file, static_cast<uintmax_t>(bytes * share));
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

/// Converts a drive that is spoilt on the way, then runs SLAM.
struct SpoiltRun {
    fs::path drive, rawlog, out;
    djpete::apps::DjpeteSlamApp app;
    Outcome outcome;

    explicit SpoiltRun(const std::string& name) : drive(copyOfSmallDrive("bad_" + name)) {
        rawlog = drive / "drive.rawlog";
        out = drive / "result";
        const auto converted =
            convert({"--input", drive.string(), "--out", rawlog.string(), "--labels", "none"});
        EXPECT_EQ(converted.code, 0) << converted.sentence;
    }
    void run() { outcome = slam(app, {rawlog.string(), "--out", out.string()}); }
    /// What was computed before frame `n` was written.
    void expectKept(uint64_t n) const {
        EXPECT_EQ(app.summary.frames, n);
        const auto text = textOf(out / "trajectory.kitti.txt");
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), static_cast<long>(n));
        EXPECT_TRUE(fs::exists(out / "scene.3Dscene"));
        EXPECT_THAT(textOf(out / "summary.json"), HasSubstr("\"error\": \""));
    }
};

TEST(BadInput, MissingFolder) {
    expectSentence(convert({"--input", "/no/such/drive", "--out", "x.rawlog"}), {"/no/such/drive"});
}

TEST(BadInput, MissingRawlogAndConfig) {
    djpete::apps::DjpeteSlamApp a, b;
    expectSentence(slam(a, {"/no/such.rawlog"}), {"/no/such.rawlog"});
    expectSentence(slam(b, {"x.rawlog"}, "/no/such.ini"), {"/no/such.ini"});
}

TEST(BadInput, NotARawlog) {
    const auto dir = scratch("bad_not_a_rawlog");
    write(dir / "drive.rawlog",
          "these are words, not observations, and there are quite a few of them");
    djpete::apps::DjpeteSlamApp app;
    expectSentence(slam(app, {(dir / "drive.rawlog").string(), "--out", (dir / "r").string()}),
                   {"drive.rawlog"});
}

TEST(BadInput, UnknownOptionAndKey) {
    const auto dir = scratch("bad_options");
    write(dir / "a.ini", "[frontend]\nfeatureswanted_ = 3\n");
    djpete::apps::DjpeteSlamApp a, b, c;
    expectSentence(slam(a, {"x.rawlog"}, (dir / "a.ini").string()), {"a.ini", "featureswanted_"});
    expectSentence(slam(b, {"x.rawlog", "--no-such-option"}), {"no-such-option"});
    expectSentence(slam(c, {"x.rawlog", "--mode", "fast"}), {"mode", "lockstep"});
}

TEST(BadInput, TruncatedPng) {
    SpoiltRun r("png");
    cutFile(r.drive / "image_1" / "000007.png", 0.4);
    r.run();
    expectSentence(r.outcome, {"image_1/000007.png", "frame 7"});
    r.expectKept(7);
}

TEST(BadInput, MissingPng) {
    SpoiltRun r("missing_png");
    fs::remove(r.drive / "image_0" / "000005.png");
    r.run();
    expectSentence(r.outcome, {"image_0/000005.png", "frame 5"});
    r.expectKept(5);
}

TEST(BadInput, TruncatedScan) {
    SpoiltRun r("scan");
    const auto scan = r.drive / "velodyne" / "000004.bin";
    fs::resize_file(scan, fs::file_size(scan) - 7);
    r.run();
    expectSentence(r.outcome, {"velodyne/000004.bin", "multiple of 16"});
    r.expectKept(4);
}

TEST(BadInput, NanInScan) {
    SpoiltRun r("nan");
    std::fstream scan(r.drive / "velodyne" / "000006.bin",
                      std::ios::in | std::ios::out | std::ios::binary);
    scan.seekp(16 * 100);
    const float nan = std::nanf("");
    scan.write(reinterpret_cast<const char*>(&nan), sizeof nan);
    scan.close();
    r.run();
    expectSentence(r.outcome, {"velodyne/000006.bin", "point", "not finite"});
    r.expectKept(6);
}

TEST(BadInput, ImagesOfTwoSizes) {
    SpoiltRun r("sizes");
    const auto other = scratch("bad_other_size");
    ASSERT_EQ(
        simulate({"--out", other.string(), "--frames", "3:4", "--size", "310x94", "--no-scans"})
            .code,
        0);
    fs::copy_file(other / "image_0" / "000003.png", r.drive / "image_0" / "000003.png",
                  fs::copy_options::overwrite_existing);
    r.run();
    expectSentence(r.outcome, {"image_0/000003.png", "310x94", "620x188"});
    r.expectKept(3);
    // The converter says so as well.
    expectSentence(convert({"--input", r.drive.string(), "--out", (r.drive / "b.rawlog").string()}),
                   {"000003.png", "310x94"});
}

TEST(BadInput, TruncatedRawlog) {
    SpoiltRun r("rawlog");
    cutFile(r.rawlog, 0.6);
    r.run();
    expectSentence(r.outcome, {"drive.rawlog"});
    EXPECT_GT(r.app.summary.frames, 0U);
    EXPECT_LT(r.app.summary.frames, 12U);
    r.expectKept(r.app.summary.frames);
}

TEST(BadInput, CalibrationMissingOrBroken) {
    const auto drive = copyOfSmallDrive("bad_calib");
    const auto out = (drive / "drive.rawlog").string();
    cutFile(drive / "calib.txt", 0.3);
    expectSentence(convert({"--input", drive.string(), "--out", out}), {"calib.txt"});
    fs::remove(drive / "calib.txt");
    expectSentence(convert({"--input", drive.string(), "--out", out}), {"calib"});
}

TEST(BadInput, WrongNumberOfColumns) {
    const auto drive = copyOfSmallDrive("bad_columns");
    const auto out = (drive / "drive.rawlog").string();
    write(drive / "label_02.txt", "0 1 Car 0 0 0 1 2 3 4 1.5 1.6 4 1 2 10 0\n1 1 Car 0 0 0\n");
    expectSentence(convert({"--input", drive.string(), "--out", out}), {"label_02.txt", "2"});
    write(drive / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1\n");
    expectSentence(convert({"--input", drive.string(), "--out", out, "--labels", "none"}),
                   {"poses.txt", "1"});
}

TEST(BadInput, ResultFolderCannotBeMade) {
    const auto dir = scratch("bad_out_folder");
    write(dir / "file", "in the way");
    SpoiltRun r("out");
    r.out = dir / "file" / "result";
    r.run();
    expectSentence(r.outcome, {"result"});
}

}  // namespace
}  // namespace djpete_test
