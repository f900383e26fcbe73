#include "point_colour.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace djpete::texture {

namespace {

constexpr float kLeastScale = 6;  // grey levels
constexpr float kTukey = 4.685F;
constexpr int kIterations = 2;

constexpr std::size_t kMost = ObjectModel::kMaxViews;

/// The samples with their channels apart, so that one instruction does several of them. Behind the
/// last one, up to a multiple of four, are samples without weight.
struct Channels {
    std::size_t count = 0, padded = 0;
    alignas(16) std::array<float, kMost> red, green, blue, weight;

    Channels(const ColourSample* samples, std::size_t n) : count(n), padded((n + 3) / 4 * 4) {
        for (std::size_t i = 0; i < n; ++i) {
            red[i] = samples[i].rgb[0];
            green[i] = samples[i].rgb[1];
            blue[i] = samples[i].rgb[2];
            weight[i] = samples[i].weight;
        }
        for (std::size_t i = n; i < padded; ++i) red[i] = green[i] = blue[i] = weight[i] = 0;
    }
    std::array<float, 3> rgb(std::size_t i) const { return {red[i], green[i], blue[i]}; }
};

using Values = std::array<float, kMost>;

/// The index whose value is the weighted median; of equal values the first index comes first.
/// Writes behind the values, up to a multiple of four.
std::size_t weightedMedian(const Channels& samples, Values& values) {
    for (std::size_t i = samples.count; i < samples.padded; ++i)
        values[i] = std::numeric_limits<float>::infinity();
    // Counting how many are less sorts few values faster than swapping them.
    alignas(16) std::array<int32_t, kMost> less{};
    for (std::size_t i = 0; i < samples.count; ++i) {
        const float value = values[i];
        for (std::size_t k = 0; k < samples.padded; ++k) less[k] += value < values[k] ? 1 : 0;
    }
    std::array<uint8_t, kMost> order, equal{};
    for (std::size_t i = 0; i < samples.count; ++i) {
        const auto place = static_cast<std::size_t>(less[i]);
        order[place + equal[place]++] = static_cast<uint8_t>(i);
    }
    Values upTo;  // weight of the samples up to here
    float total = 0;
    for (std::size_t i = 0; i < samples.count; ++i) {
        total += samples.weight[order[i]];
        upTo[i] = total;
    }
    std::size_t middle = 0;
    while (2 * upTo[middle] < total) ++middle;
    return order[middle];
}

void findDistances(const Channels& s, const std::array<float, 3>& from, Values& out) {
    for (std::size_t i = 0; i < s.padded; ++i) {
        const float r = s.red[i] - from[0], g = s.green[i] - from[1], b = s.blue[i] - from[2];
        out[i] = std::sqrt((r * r + g * g + b * b) / 3);
    }
}

/// How much say each sample has at these distances; beyond `width` none.
void findSay(const Channels& s, const Values& distances, float width, Values& out) {
    for (std::size_t i = 0; i < s.padded; ++i) {
        const float x = distances[i] / width;
        const float inside = std::max(0.0F, 1 - x * x);
        out[i] = s.weight[i] * inside * inside;
    }
}

}  // namespace

PointColour robustColour(const ColourSample* samples, std::size_t count) {
    PointColour out;
    const Channels s(samples, count);
    alignas(16) Values values, say = s.weight;
    if (count > 2) {
        for (std::size_t i = 0; i < s.padded; ++i) values[i] = s.red[i] + s.green[i] + s.blue[i];
        std::array<float, 3> centre = s.rgb(weightedMedian(s, values));
        findDistances(s, centre, values);
        const float scale = values[weightedMedian(s, values)];
        const float width = kTukey * std::max(kLeastScale, 1.4826F * scale);
        findSay(s, values, width, say);
        for (int k = 0; k < kIterations; ++k) {
            std::array<float, 3> sum{};
            float total = 0;
            for (std::size_t i = 0; i < count; ++i) {
                sum[0] += say[i] * s.red[i];
                sum[1] += say[i] * s.green[i];
                sum[2] += say[i] * s.blue[i];
                total += say[i];
            }
            if (!(total > 0)) break;
            for (std::size_t c = 0; c < 3; ++c) centre[c] = sum[c] / total;
            findDistances(s, centre, values);
            findSay(s, values, width, say);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (!(say[i] > 0)) continue;
        out.sum.add(s.rgb(i), say[i]);
        out.seenIn |= 1U << samples[i].view;
    }
    return out;
}

}  // namespace djpete::texture
