#include "djpete/obs/rle_mask.h"

#include <gtest/gtest.h>

#include <random>

using djpete::obs::RleMask;

TEST(RleMask, RunsStartWithBackground) {
    const std::vector<uint8_t> dense{1, 1, 0, 0, 9, 0};
    const RleMask m = RleMask::fromDense(dense.data(), 3, 2, 3);
    EXPECT_EQ(m.runs, (std::vector<uint32_t>{0, 2, 2, 1, 1}));
    EXPECT_EQ(m.area_px(), 3U);
    EXPECT_EQ(m.toDense(), (std::vector<uint8_t>{255, 255, 0, 0, 255, 0}));
}

TEST(RleMask, EmptyImageAndEmptyMask) {
    EXPECT_TRUE(RleMask::fromDense(nullptr, 0, 0, 0).consistent());
    const std::vector<uint8_t> dense(12, 0);
    const RleMask m = RleMask::fromDense(dense.data(), 4, 3, 4);
    EXPECT_EQ(m.area_px(), 0U);
    EXPECT_EQ(m.toDense(), dense);
}

TEST(RleMask, RandomMasksSurviveTheRoundTripWithPaddedRows) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const auto w = 1 + random() % 40, h = 1 + random() % 30;
        const std::size_t stride = w + random() % 5;
        const unsigned density = 1 + random() % 8;
        std::vector<uint8_t> padded(stride * h, 77), dense;
        uint64_t area = 0;
        for (std::size_t v = 0; v < h; ++v) {
            for (std::size_t u = 0; u < w; ++u) {
                const bool on = random() % 8 < density;
                padded[v * stride + u] = on ? static_cast<uint8_t>(1 + random() % 255) : 0;
                dense.push_back(on ? 255 : 0);
                area += on ? 1U : 0U;
            }
        }
        const RleMask m = RleMask::fromDense(padded.data(), static_cast<uint32_t>(w),
                                             static_cast<uint32_t>(h), stride);
        ASSERT_TRUE(m.consistent());
        ASSERT_EQ(m.area_px(), area);
        ASSERT_EQ(m.toDense(), dense);
    }
}

TEST(RleMask, RunsThatDoNotFitAreInconsistentAndNeverOverflow) {
    const RleMask tooLong{3, 2, {1, 100}};
    EXPECT_FALSE(tooLong.consistent());
    EXPECT_EQ(tooLong.toDense().size(), 6U);
    EXPECT_FALSE((RleMask{3, 2, {1, 2}}.consistent()));
}
