/// --fault exposure=F: exposure.txt says what the images show.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "djpete/obs/errors.h"
#include "small_drive.h"

using namespace small_drive;
using testing::HasSubstr;

namespace {

using Words = std::vector<std::string>;

constexpr int kFrames = 26;  // two turns and a bit

/// Options of a drive without scans into a folder.
Words words(const fs::path& dir, const Words& more) {
    Words out{"--out",      dir.string(), "--frames", "0:" + std::to_string(kFrames),
              "--size",     "124x38",     "--seed",   "2",
              "--no-scans", "--no-color"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

fs::path driven(const std::string& name, const Words& more) {
    const auto dir = djpete_test::scratch("sim_exposure_" + name);
    simulate(words(dir, more));
    return dir;
}

const fs::path& plain() {
    static const fs::path dir = driven("plain", {});
    return dir;
}

const fs::path& swinging() {
    static const fs::path dir = driven("swing", {"--fault", "exposure=0.4"});
    return dir;
}

/// By what the exposure of each frame differs from the drive's without the fault.
std::vector<double> factors(const fs::path& dir) {
    const auto before = numbersOf(plain() / "exposure.txt"), now = numbersOf(dir / "exposure.txt");
    EXPECT_EQ(now.size(), static_cast<std::size_t>(kFrames));
    std::vector<double> out;
    for (std::size_t f = 0; f < now.size(); ++f) {
        EXPECT_EQ(now[f][1], now[f][2]) << "both cameras alike";
        out.push_back(now[f][1] / before[f][1]);
    }
    return out;
}

/// Median of the ratios of grey values of two images, where both are far from black and white.
double ratioOf(const fs::path& now, const fs::path& before) {
    const cv::Mat a = cv::imread(now.string(), cv::IMREAD_UNCHANGED);
    const cv::Mat b = cv::imread(before.string(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(a.size(), b.size());
    std::vector<double> ratios;
    for (int v = 0; v < a.rows; ++v) {
        for (int u = 0; u < a.cols; ++u) {
            const int x = a.at<uint8_t>(v, u), y = b.at<uint8_t>(v, u);
            if (std::min(x, y) < 40 || std::max(x, y) > 230) continue;
            ratios.push_back(static_cast<double>(x) / y);
        }
    }
    EXPECT_GT(ratios.size(), 200U);
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
}

}  // namespace

TEST(ExposureFault, GoesUpAndDownWithinItsBounds) {
    const auto f = factors(swinging());
    const auto [least, most] = std::minmax_element(f.begin(), f.end());
    EXPECT_GE(*least, 1 / 1.4);
    EXPECT_LE(*most, 1.4);
    EXPECT_LT(*least, std::pow(1.4, -0.69));
    EXPECT_GT(*most, std::pow(1.4, 0.69));
    EXPECT_EQ(textOf(swinging() / "faults.txt").substr(0, 18), "exposure=0.4 0 25 ");
}

TEST(ExposureFault, HasSmoothAndQuickTurns) {
    const sim::World world(Scene::options(2));
    // The largest change from one frame to the next within each turn of a long drive.
    std::vector<double> steps(8, 0);
    sim::CameraModel model;
    model.autoExposure = false;
    model.exposureSwing = 0.4;
    sim::Renderer renderer(world, 1, model);
    const auto camera = sim::rigCamera(64, 32);
    double before = 0;
    for (uint64_t f = 0; f < 40; ++f) {
        const double now =
            std::log(renderer.renderCamera(f, camera, sim::T_vehicle_camera(), 0).exposure);
        if (f > 0) {
            double& step = steps[(f - 1) / 12];
            step = std::max(step, std::abs(now - before));
        }
        before = now;
    }
    const double whole = 2 * std::log(1.4);
    for (const double step : {steps[0], steps[1], steps[2]}) EXPECT_GT(step, 0.08 * whole);
    EXPECT_LT(*std::min_element(steps.begin(), steps.begin() + 3), 0.13 * whole);
    EXPECT_GT(*std::max_element(steps.begin(), steps.begin() + 3), 0.25 * whole);
}

TEST(ExposureFault, ImagesFollowExposureTxt) {
    const auto f = factors(swinging());
    for (const int frame : {0, 6, 12, 18, 24}) {
        char name[32];
        std::snprintf(name, sizeof name, "%06d.png", frame);
        // The tone curve is a power of 1 / 1.15.
        const double expected = std::pow(f[static_cast<std::size_t>(frame)], 1 / 1.15);
        for (const char* camera : {"image_0", "image_1"}) {
            EXPECT_NEAR(ratioOf(swinging() / camera / name, plain() / camera / name), expected,
                        0.02 * expected)
                << camera << "/" << name;
        }
    }
}

TEST(ExposureFault, ChangesImagesAndNothingElse) {
    const auto before = filesOf(plain()), now = filesOf(swinging());
    for (const auto& [name, bytes] : before) {
        const bool mayDiffer = name.compare(0, 6, "image_") == 0 || name == "exposure.txt" ||
                               name == "drive_options.txt";
        if (mayDiffer) continue;
        EXPECT_TRUE(now.at(name) == bytes) << name;
    }
}

TEST(ExposureFault, GivesTheSameBytesForAnyThreadsRangeAndAfterABreak) {
    const auto whole = filesOf(swinging());
    const auto dir = driven("again", {"--fault", "exposure=0.4", "--threads", "1"});
    EXPECT_TRUE(filesOf(dir) == whole);
    fs::resize_file(dir / "image_1" / "000013.png", 300);  // no end
    fs::remove(dir / "image_0" / "000021.png");
    simulate(words(dir, {"--fault", "exposure=0.4", "--resume"}));
    EXPECT_TRUE(filesOf(dir) == whole);
    // A later frame alone has the image that it has in the whole drive.
    const auto alone = djpete_test::scratch("sim_exposure_alone");
    simulate({"--out", alone.string(), "--frames", "20:21", "--size", "124x38", "--seed", "2",
              "--no-scans", "--no-color", "--fault", "exposure=0.4"});
    EXPECT_TRUE(textOf(alone / "image_0/000020.png") == whole.at("image_0/000020.png"));
}

TEST(ExposureFault, IsGivenOnce) {
    try {
        simulate({"--out", "never_made", "--fault", "exposure=0.4", "--fault", "exposure=0.2"});
        FAIL() << "accepted";
    } catch (const djpete::obs::InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("--fault exposure=0.2: expected it only once"));
    }
}

TEST(ExposureFault, ResumeRefusesAnotherAmount) {
    const auto dir = djpete_test::scratch("sim_exposure_other");
    simulate(words(dir, {"--fault", "exposure=0.4"}));
    try {
        simulate(words(dir, {"--fault", "exposure=0.3", "--resume"}));
        FAIL() << "accepted";
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), HasSubstr("begun with 'faults exposure=0.4@0:26'"));
    }
}
