/// The fast colour of a point is, bit for bit, what its description says.
#include "point_colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "disc.h"

using namespace djpete::texture;

namespace {

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    const float r = a[0] - b[0], g = a[1] - b[1], h = a[2] - b[2];
    return std::sqrt((r * r + g * g + h * h) / 3);
}

/// Index of the weighted median, by sorting.
std::size_t median(const std::vector<float>& values, const std::vector<ColourSample>& samples) {
    std::vector<std::size_t> order(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    float total = 0, below = 0;
    for (const std::size_t i : order) total += samples[i].weight;
    for (const std::size_t i : order) {
        below += samples[i].weight;
        if (2 * below >= total) return i;
    }
    return order.back();
}

/// Tukey's biweight mean, step by step.
PointColour slowColour(const std::vector<ColourSample>& samples) {
    std::array<float, 3> centre{};
    float width = 0;
    if (samples.size() > 2) {
        std::vector<float> values;
        for (const auto& s : samples) values.push_back(s.rgb[0] + s.rgb[1] + s.rgb[2]);
        centre = samples[median(values, samples)].rgb;
        for (std::size_t i = 0; i < samples.size(); ++i)
            values[i] = distance(samples[i].rgb, centre);
        width = 4.685F * std::max(6.0F, 1.4826F * values[median(values, samples)]);
    }
    const auto say = [&](const ColourSample& s) {
        if (width <= 0) return s.weight;
        const float x = distance(s.rgb, centre) / width;
        const float inside = std::max(0.0F, 1 - x * x);
        return s.weight * inside * inside;
    };
    for (int k = 0; width > 0 && k < 2; ++k) {
        std::array<float, 3> sum{};
        float total = 0;
        for (const auto& s : samples) {
            const float w = say(s);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += w * s.rgb[c];
            total += w;
        }
        if (!(total > 0)) break;
        for (std::size_t c = 0; c < 3; ++c) centre[c] = sum[c] / total;
    }
    PointColour out;
    for (const auto& s : samples) {
        const float w = say(s);
        if (!(w > 0)) continue;
        out.sum.add(s.rgb, w);
        out.seenIn |= 1U << s.view;
    }
    return out;
}

/// Samples around one colour, some far off; `rounded`: so that many are equal.
std::vector<ColourSample> randomSamples(std::mt19937_64& dice, std::size_t count, bool rounded) {
    const auto unit = [&] { return static_cast<float>(dice() >> 40U) / 16777216.0F; };
    const float level = 255 * unit();
    std::vector<ColourSample> out;
    for (unsigned k = 0; k < count; ++k) {
        const float spread = unit() < 0.2F ? 200.0F : 20.0F;
        ColourSample s;
        for (float& c : s.rgb) {
            c = std::clamp(level + spread * (unit() - 0.5F), 0.0F, 255.0F);
            if (rounded) c = std::round(c / 10) * 10;
        }
        s.weight = 0.004F + unit();
        s.view = k;
        out.push_back(s);
    }
    return out;
}

bool sameBits(const PointColour& a, const PointColour& b) {
    return a.seenIn == b.seenIn && a.sum.count == b.sum.count &&
           std::memcmp(&a.sum.weight, &b.sum.weight, sizeof(float)) == 0 &&
           std::memcmp(&a.sum.mean, &b.sum.mean, sizeof a.sum.mean) == 0 &&
           std::memcmp(&a.sum.m2, &b.sum.m2, sizeof a.sum.m2) == 0;
}

}  // namespace

TEST(PointColours, AreThoseOfThePlainFormulaBitForBit) {
    std::mt19937_64 dice(7);
    for (int trial = 0; trial < 20000; ++trial) {
        const std::size_t count = dice() % (ObjectModel::kMaxViews + 1);
        const auto samples = randomSamples(dice, count, trial % 2 == 1);
        ASSERT_TRUE(sameBits(robustColour(samples.data(), count), slowColour(samples)))
            << "trial " << trial << ", " << count << " samples";
    }
}

TEST(PointColours, LeaveAHighlightOut) {
    std::vector<ColourSample> samples;
    for (unsigned k = 0; k < 7; ++k) {
        const float v = k == 3 ? 250.0F : 80.0F + static_cast<float>(k);
        samples.push_back({{v, v, v}, 1, k});
    }
    const PointColour colour = robustColour(samples.data(), samples.size());
    EXPECT_EQ(colour.seenIn, 0x77U);
    EXPECT_NEAR(colour.sum.mean[0], 83, 0.6);
}

TEST(Discs, RoundDownAsTheLibraryDoes) {
    std::mt19937_64 dice(3);
    for (int trial = 0; trial < 100000; ++trial) {
        const double x = static_cast<double>(static_cast<int64_t>(dice())) / 4e15;
        ASSERT_EQ(floorToInt(x), static_cast<int>(std::floor(x)));
        const auto y = static_cast<float>(x);
        ASSERT_EQ(floorToInt(y), static_cast<int>(std::floor(y)));
    }
    for (const double x : {-2.0, -1.0, -0.5, -0.0, 0.0, 0.5, 1.0, 2.0}) {
        EXPECT_EQ(floorToInt(x), static_cast<int>(std::floor(x))) << x;
    }
}
