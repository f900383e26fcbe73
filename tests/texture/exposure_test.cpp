#include "djpete/texture/exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace djpete::texture;
using djpete::obs::FrameId;

std::vector<FrameId> framesUpTo(uint64_t count) {
    std::vector<FrameId> out;
    for (uint64_t f = 0; f < count; ++f) out.push_back(FrameId{f});
    return out;
}

double trueGain(uint64_t frame) {
    return std::exp(0.4 * std::sin(0.7 * static_cast<double>(frame)));
}

TEST(Gains, AreFoundUpToOneCommonFactor) {
    constexpr uint64_t kFrames = 30;
    std::vector<ExposurePair> pairs;
    for (uint64_t f = 0; f + 1 < kFrames; ++f) {
        for (const uint64_t step : {1U, 2U, 4U}) {
            if (f + step >= kFrames) continue;
            pairs.push_back(
                {FrameId{f}, FrameId{f + step}, std::log(trueGain(f) / trueGain(f + step)), 1000});
        }
    }
    const auto gains = solveGains(framesUpTo(kFrames), pairs);
    ASSERT_EQ(gains.size(), kFrames);
    double logs = 0;
    for (const auto& [frame, gain] : gains) logs += std::log(gain);
    EXPECT_NEAR(logs, 0, 1e-9);
    const double factor = gains.at(FrameId{0}) / trueGain(0);
    for (const auto& [frame, gain] : gains) {
        EXPECT_NEAR(gain / trueGain(frame.value), factor, 0.02 * factor) << frame.value;
    }
}

TEST(Gains, OfImagesWithoutCommonPointsLieBetweenTheirNeighbours) {
    const std::vector<ExposurePair> pairs{{FrameId{0}, FrameId{1}, 0, 1e4},
                                          {FrameId{4}, FrameId{5}, 0, 1e4},
                                          {FrameId{0}, FrameId{5}, std::log(2.0), 1e4},
                                          {FrameId{0}, FrameId{77}, 9, 1e4}};  // unknown frame
    const auto gains = solveGains(framesUpTo(6), pairs);
    EXPECT_NEAR(gains.at(FrameId{0}) / gains.at(FrameId{5}), 2, 0.01);
    for (uint64_t f = 1; f < 5; ++f) {
        EXPECT_GE(gains.at(FrameId{f}) * 1.0001, gains.at(FrameId{f + 1}));
    }
    EXPECT_TRUE(solveGains({}, pairs).empty());
}

TEST(Exposure, GainAndOffsetAreFoundAmongOutliers) {
    std::mt19937_64 random(3);
    ExposureSamples samples;
    for (int i = 0; i < 2000; ++i) {
        const auto common = static_cast<float>(20 + random() % 180);
        const auto noise = static_cast<float>(static_cast<double>(random() % 1000) / 100 - 5);
        samples.common.push_back(common);
        samples.shown.push_back(i % 8 == 0 ? 240.0F : 1.3F * common - 6 + noise);
        samples.weight.push_back(1);
    }
    const Exposure found = fitExposure(samples, {});
    EXPECT_NEAR(found.gain, 1.3, 0.06);
    EXPECT_NEAR(found.offset, -6, 6);
    const auto back = found.corrected({1.3F * 100 - 6, 1.3F * 50 - 6, 1.3F * 150 - 6});
    EXPECT_NEAR(back[0], 100, 5);
    EXPECT_NEAR(back[1], 50, 5);
    EXPECT_NEAR(back[2], 150, 6);
}

TEST(Exposure, StaysAtTheGuessWithoutSamples) {
    const Exposure guess{1.2, 3};
    const Exposure found = fitExposure({}, guess);
    EXPECT_NEAR(found.gain, guess.gain, 1e-12);
    EXPECT_NEAR(found.offset, guess.offset, 1e-12);
}

}  // namespace
