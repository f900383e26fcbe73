// Wear of roads: no period along the street, and nothing breaks off.
#include "ground_wear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace djpete::simulator;

/// Along 24 m of a lane, 0.2 m apart in both directions.
std::vector<float> lane(float from_m, uint32_t seed) {
    std::vector<float> out;
    for (float u = 0; u < 24.F; u += 0.2F)
        for (float v = -3.F; v < 0.F; v += 0.2F)
            out.push_back(roadWearAt(Vec2f(from_m + u, v), 0.02F, seed));
    return out;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
    const auto mean = [](const std::vector<float>& x) {
        double sum = 0;
        for (float v : x) sum += static_cast<double>(v);
        return sum / static_cast<double>(x.size());
    };
    const double ma = mean(a), mb = mean(b);
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = static_cast<double>(a[i]) - ma, y = static_cast<double>(b[i]) - mb;
        ab += x * y, aa += x * x, bb += y * y;
    }
    return ab / std::sqrt(aa * bb);
}

TEST(GroundWear, HasNoPeriodAlongTheStreet) {
    const auto here = lane(-12, 5);
    EXPECT_GT(correlation(here, lane(-12, 5)), 0.999);
    for (int tile = 1; tile <= 20; ++tile)
        EXPECT_LT(std::abs(correlation(here, lane(-12 + 24.F * static_cast<float>(tile), 5))), 0.5)
            << tile << " tiles on";
}

TEST(GroundWear, StreetsDiffer) {
    for (uint32_t other = 6; other < 16; ++other)
        EXPECT_LT(std::abs(correlation(lane(0, 5), lane(0, other))), 0.5) << other;
}

TEST(GroundWear, StretchesRunIntoEachOther) {
    // Across a border (at 0, 24, ..) and the ends of its blend there is no step: what a millimetre
    // changes elsewhere is as much.
    double atBorders = 0, elsewhere = 0;
    for (int tile = -3; tile < 30; ++tile) {
        for (float v = -5.F; v < 5.F; v += 0.1F) {
            const auto change = [&](float u) {
                return static_cast<double>(std::abs(roadWearAt(Vec2f(u + 0.001F, v), 0.02F, 3U) -
                                                    roadWearAt(Vec2f(u - 0.001F, v), 0.02F, 3U)));
            };
            const float border = 24.F * static_cast<float>(tile);
            for (float at : {-0.75F, 0.F, 0.75F})
                atBorders = std::max(atBorders, change(border + at));
            for (float at : {5.F, 9.F, 14.F}) elsewhere = std::max(elsewhere, change(border + at));
        }
    }
    EXPECT_LT(atBorders, 1.5 * elsewhere + 0.02);
}

TEST(GroundWear, SeamsRunOnFromStretchToStretch) {
    // The darkest line along the street is where it was before the border, within its wandering.
    const auto seamNear = [](float u, float guess) {
        float best = 9, where = guess;
        for (float v = guess - 2; v < guess + 2; v += 0.02F) {
            float sum = 0;
            for (float d = -1.F; d <= 1.F; d += 0.1F)
                sum += roadWearAt(Vec2f(u + d, v), 0.02F, 11U);
            if (sum < best * 21) best = sum / 21, where = v;
        }
        return std::pair(where, best);
    };
    int seen = 0;
    for (int tile = 1; tile < 40; ++tile) {
        const float border = 24.F * static_cast<float>(tile);
        const auto [before, dark] = seamNear(border - 2.F, 0.F);
        const auto [after, dark2] = seamNear(border + 2.F, 0.F);
        if (dark > 0.62F || dark2 > 0.62F) continue;  // not sealed on both sides
        ++seen;
        EXPECT_NEAR(before, after, 0.15F) << tile;
    }
    EXPECT_GT(seen, 2);
}

}  // namespace
