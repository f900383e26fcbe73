#include "djpete/background/octo_worker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_test/shared_data.h"
#include "made_up_street.h"

namespace {

using namespace djpete_test;
using background::OctoOptions;
using background::OctoWorker;

constexpr int kFrames = 6;

mrpt::Clock::time_point second(double s) { return mrpt::Clock::fromDouble(1.6e9 + s); }

std::string drive(bool threaded, const OctoOptions& options, const std::string& name) {
    OctoWorker worker(options, threaded);
    for (int f = 0; f < kFrames; ++f) {
        if (worker.wants(second(f))) worker.push(Street::view(f, true));
    }
    worker.finish(streetMap(kFrames, SE3::fromYaw(0.01, {0, 1, 0})));
    const auto file = djpete_test::scratch("octo_worker_" + name) / "a.ot";
    worker.tree().writeOt(file.string());
    std::ifstream in(file, std::ios::binary);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
}

TEST(OctoWorker, AFullQueueDoesNotChangeTheResult) {
    OctoOptions narrow;
    narrow.queue_keyframes = 1;
    const auto lockstep = drive(false, OctoOptions(), "lockstep");
    EXPECT_GT(lockstep.size(), 10000U);
    EXPECT_EQ(lockstep, drive(true, OctoOptions(), "threaded"));
    EXPECT_EQ(lockstep, drive(true, narrow, "narrow"));
}

TEST(OctoWorker, SkippingIsCounted) {
    OctoOptions options;
    options.queue_keyframes = 1;
    options.when_full = "skip";
    OctoWorker worker(options, true);
    const auto view = Street::view(0, true);
    constexpr uint64_t kViews = 50;
    for (uint64_t i = 0; i < kViews; ++i) worker.push(view);
    worker.finish(streetMap(1));
    const auto counters = worker.counters();
    const uint64_t skipped = counters.at("rejected: octomap keyframes, queue full");
    EXPECT_EQ(counters.at("octomap keyframes") + skipped, kViews);
    EXPECT_GT(skipped, 0U);  // a view takes far longer than fifty pushes
}

TEST(OctoWorker, KeyframesTooCloseInTimeAreLeftOut) {
    OctoOptions options;
    options.min_period_s = 0.95;
    OctoWorker worker(options, false);
    std::vector<bool> wanted;
    for (int i = 0; i < 6; ++i) wanted.push_back(worker.wants(second(0.5 * i)));
    EXPECT_EQ(wanted, (std::vector<bool>{true, false, true, false, true, false}));
    EXPECT_EQ(worker.counters().at("octomap keyframes left out by min_period_s"), 3U);
}

TEST(OctoWorker, FinishSaysWhichFrameCouldNotBeUsed) {
    for (const bool threaded : {false, true}) {
        OctoWorker worker(OctoOptions(), threaded);
        worker.push(Street::view(0, true));
        auto broken = Street::view(1, true);
        broken.images.left = mrpt::img::CImage(16, 16, mrpt::img::CH_RGB);
        worker.push(std::move(broken));
        worker.push(Street::view(2, true));
        try {
            worker.finish(streetMap(3));
            FAIL();
        } catch (const djpete::obs::InputError& e) {
            EXPECT_NE(std::string(e.what()).find("frame 1"), std::string::npos) << e.what();
        }
    }
}

}  // namespace
