#include "point_colour.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

constexpr float kLeastScale = 6;  // grey levels
constexpr float kTukey = 4.685F;
constexpr int kIterations = 2;

struct Weighted {
    float value = 0, weight = 0;
    std::size_t index = 0;
};

Weighted weightedMedian(Weighted* values, std::size_t count) {
    std::sort(values, values + count, [](const Weighted& a, const Weighted& b) {
        return a.value < b.value || (a.value == b.value && a.index < b.index);
    });
    float total = 0;
    for (std::size_t i = 0; i < count; ++i) total += values[i].weight;
    float below = 0;
    for (std::size_t i = 0; i < count; ++i) {
        below += values[i].weight;
        if (2 * below >= total) return values[i];
    }
    return values[count - 1];
}

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    const float r = a[0] - b[0], g = a[1] - b[1], h = a[2] - b[2];
    return std::sqrt((r * r + g * g + h * h) / 3);
}

}  // namespace

PointColour robustColour(const ColourSample* samples, std::size_t count) {
    PointColour out;
    std::array<float, 3> centre{};
    float width = 0;  // beyond it a sample has no say; 0: all have their full one
    if (count > 2) {
        std::array<Weighted, ObjectModel::kMaxViews> values;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& rgb = samples[i].rgb;
            values[i] = {rgb[0] + rgb[1] + rgb[2], samples[i].weight, i};
        }
        centre = samples[weightedMedian(values.data(), count).index].rgb;
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = {distance(samples[i].rgb, centre), samples[i].weight, i};
        }
        width =
            kTukey * std::max(kLeastScale, 1.4826F * weightedMedian(values.data(), count).value);
    }
    const auto say = [&](const ColourSample& s) {
        if (width <= 0) return s.weight;
        const float x = distance(s.rgb, centre) / width;
        const float inside = std::max(0.0F, 1 - x * x);
        return s.weight * inside * inside;
    };
    for (int k = 0; width > 0 && k < kIterations; ++k) {
        std::array<float, 3> sum{};
        float total = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const float w = say(samples[i]);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += w * samples[i].rgb[c];
            total += w;
        }
        if (!(total > 0)) break;
        for (std::size_t c = 0; c < 3; ++c) centre[c] = sum[c] / total;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float w = say(samples[i]);
        if (!(w > 0)) continue;
        out.sum.add(samples[i].rgb, w);
        out.seenIn |= 1U << samples[i].view;
    }
    return out;
}

}  // namespace djpete::texture
