/// Every fault is where it was asked for, and nowhere else.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "djpete/obs/errors.h"
#include "small_drive.h"

using namespace small_drive;
using testing::HasSubstr;

namespace {

/// Leaves only what is the same for all frames, in no time.
constexpr const char* kNoFrames = "dropped-frames@0:2";

/// Two frames with these faults.
fs::path faulty(const std::string& name, const std::vector<std::string>& faults) {
    const auto dir = djpete_test::scratch("sim_fault_" + name);
    std::vector<std::string> words{"--out",  dir.string(), "--frames", "0:2",
                                   "--size", "124x38",     "--seed",   "2"};
    for (const auto& f : faults) words.insert(words.end(), {"--fault", f});
    simulate(words);
    return dir;
}

const fs::path& faultless() {
    static const fs::path dir = faulty("none", {});
    return dir;
}

/// Files that differ from the faultless drive's or are in one of them only, without those that
/// tell what was done.
std::vector<std::string> changed(const fs::path& dir) {
    auto good = filesOf(faultless()), bad = filesOf(dir);
    std::vector<std::string> out;
    for (const auto& [name, bytes] : good) {
        if (bad.count(name) == 0 || bad.at(name) != bytes) out.push_back(name);
    }
    for (const auto& [name, bytes] : bad) {
        if (good.count(name) == 0) out.push_back(name);
    }
    const auto tells = [](const std::string& n) {
        return n == "faults.txt" || n == "drive_options.txt";
    };
    out.erase(std::remove_if(out.begin(), out.end(), tells), out.end());
    return out;
}

std::vector<std::array<float, 4>> scanOf(const fs::path& file) {
    const std::string bytes = textOf(file);
    std::vector<std::array<float, 4>> out(bytes.size() / 16);
    std::memcpy(out.data(), bytes.data(), out.size() * 16);
    return out;
}

/// The numbers after a key of calib.txt.
Eigen::Matrix<double, 3, 4> calibration(const fs::path& dir, const std::string& key) {
    std::istringstream in(textOf(dir / "calib.txt"));
    for (std::string word; in >> word;) {
        if (word != key) continue;
        Eigen::Matrix<double, 3, 4> m;
        for (int i = 0; i < 12; ++i) in >> m(i / 4, i % 4);
        return m;
    }
    ADD_FAILURE() << key;
    return Eigen::Matrix<double, 3, 4>::Zero();
}

std::string refusal(const std::string& fault) {
    try {
        simulate({"--out", "never_made", "--frames", "0:9", "--fault", fault});
    } catch (const djpete::obs::InputError& e) {
        return e.what();
    }
    return "(accepted)";
}

}  // namespace

TEST(SimulatedFaults, BlackAndSwappedImages) {
    const auto dir = faulty("images", {"black-frames@0:1", "swapped-cameras@1:2"});
    for (const char* image : {"image_0/000000.png", "image_1/000000.png", "image_3/000000.png"}) {
        const cv::Mat black = cv::imread((dir / image).string(), cv::IMREAD_UNCHANGED);
        ASSERT_EQ(black.cols, 124) << image;
        EXPECT_EQ(cv::norm(black, cv::NORM_INF), 0) << image;
    }
    const auto good = filesOf(faultless()), bad = filesOf(dir);
    EXPECT_TRUE(bad.at("image_0/000001.png") == good.at("image_1/000001.png"));
    EXPECT_TRUE(bad.at("image_1/000001.png") == good.at("image_0/000001.png"));
    EXPECT_TRUE(bad.at("image_2/000001.png") == good.at("image_3/000001.png"));
    EXPECT_EQ(changed(dir).size(), 8U);  // images only: the truth stays
    EXPECT_EQ(bad.at("faults.txt"),
              "black-frames 0 0 all images are black\n"
              "swapped-cameras 1 1 left and right images change places\n");
}

TEST(SimulatedFaults, DroppedFramesLeaveNoFileAndNoLabel) {
    const auto dir = faulty("dropped", {"dropped-frames@1:2"});
    for (const auto& [name, bytes] : filesOf(dir)) {
        EXPECT_EQ(name.find("000001"), std::string::npos) << name;
    }
    EXPECT_THAT(textOf(faultless() / "label_02.txt"), HasSubstr("\n1 "));
    EXPECT_EQ(textOf(dir / "label_02.txt").find("\n1 "), std::string::npos);
    EXPECT_EQ(numbersOf(dir / "poses.txt").size(), 2U);  // rows are frames
    EXPECT_TRUE(fs::exists(dir / "image_0" / "000000.png"));
}

TEST(SimulatedFaults, TimesJump) {
    const auto times = numbersOf(faulty("times", {"time-jump@1:2", kNoFrames}) / "times.txt");
    EXPECT_NEAR(times[0][0], 0.0, 1e-9);
    EXPECT_NEAR(times[1][0], 1.1, 1e-9);
}

TEST(SimulatedFaults, WrongCalibration) {
    const auto right = faulty("calibrated", {kNoFrames});
    const double baseline = calibration(right, "P1:")(0, 3);
    const auto longer = faulty("longer", {"baseline+1%", kNoFrames});
    EXPECT_NEAR(calibration(longer, "P1:")(0, 3) / baseline, 1.01, 1e-9);
    EXPECT_NEAR(calibration(longer, "P3:")(0, 3) / baseline, 1.01, 1e-9);
    EXPECT_EQ(calibration(longer, "Tr:"), calibration(right, "Tr:"));
    const auto others = faulty("tilted", {"baseline-1%", "extrinsic-tilt", kNoFrames});
    EXPECT_NEAR(calibration(others, "P1:")(0, 3) / baseline, 0.99, 1e-9);
    EXPECT_EQ(calibration(others, "P2:"), calibration(right, "P2:"));
    const Eigen::Matrix3d turn = calibration(others, "Tr:").leftCols<3>() *
                                 calibration(right, "Tr:").leftCols<3>().transpose();
    EXPECT_NEAR(SE3(turn, Vec3::Zero()).angle_rad() * 180 / M_PI, 1.0, 1e-6);
}

TEST(SimulatedFaults, ScansWithHolesAndWithFewBeams) {
    const auto dir = faulty("scans", {"nan-points@0:1", "sparse-beams@1:2"});
    EXPECT_THAT(changed(dir), testing::ElementsAre("velodyne/000000.bin", "velodyne/000001.bin"));
    const auto holes = scanOf(dir / "velodyne" / "000000.bin");
    ASSERT_EQ(holes.size(), scanOf(faultless() / "velodyne" / "000000.bin").size());
    double nan = 0;
    for (const auto& p : holes) nan += std::isnan(p[0]) && std::isnan(p[2]) ? 1 : 0;
    EXPECT_NEAR(nan / static_cast<double>(holes.size()), 0.05, 0.005);
    // Beams follow each other in the file, each once around from ahead: 16 of them.
    int turns = 1;
    double last = -1;
    for (const auto& p : scanOf(dir / "velodyne" / "000001.bin")) {
        double azimuth = std::atan2(p[1], p[0]);
        if (azimuth < 0) azimuth += 2 * M_PI;
        if (azimuth < last) ++turns;
        last = azimuth;
    }
    EXPECT_EQ(turns, 16);
}

TEST(SimulatedFaults, StandInTheMiddleIfNobodySaysWhere) {
    const auto third = sim::faultAtItsPlace(sim::FaultKind::TimeJump, 10, 40);
    EXPECT_EQ(third.begin, 20U);
    EXPECT_EQ(third.end, 30U);
    const auto few = sim::faultAtItsPlace(sim::FaultKind::DroppedFrames, 0, 101);
    EXPECT_EQ(few.begin, 48U);
    EXPECT_EQ(few.end, 53U);
    const auto one = sim::faultAtItsPlace(sim::FaultKind::BlackFrames, 7, 8);
    EXPECT_EQ(one.begin, 7U);
    EXPECT_EQ(one.end, 8U);
}

TEST(SimulatedFaults, WrongWordsGetASentence) {
    const std::string said = refusal("blck-frames");
    EXPECT_THAT(said, HasSubstr("--fault blck-frames: expected one of dropped-frames"));
    for (const auto& f : sim::faultNames()) EXPECT_THAT(said, HasSubstr(f.name));
    EXPECT_THAT(refusal("baseline+1%@0:3"), HasSubstr("holds for the whole drive"));
    EXPECT_THAT(refusal("time-jump@20:30"), HasSubstr("expected frames of the drive, 0:9"));
    EXPECT_THAT(refusal("time-jump@5:2"), HasSubstr("5:2"));
    EXPECT_THAT(refusal("time-jump=2"), HasSubstr("time-jump has no number"));
    for (const char* wrong : {"exposure", "exposure=", "exposure=0", "exposure=2.5", "exposure=1x",
                              "exposure=nan"}) {
        EXPECT_THAT(refusal(wrong), HasSubstr(std::string("--fault ") + wrong +
                                              ": expected exposure=F with a number F above 0"));
    }
    EXPECT_THAT(refusal("exposure=0.4@0:3"), HasSubstr("holds for the whole drive"));
}
