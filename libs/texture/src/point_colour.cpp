#include "point_colour.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace djpete::texture {

namespace {

constexpr float kLeastScale = 6;  // grey levels
constexpr float kTukey = 4.685F;
constexpr int kIterations = 2;

/// Sums and distances of N samples (a multiple of four, known to the compiler), so that one
/// instruction does four of them. Behind the last one are samples without weight.
template <std::size_t N>
class Samples {
  public:
    Samples(const ColourSample* samples, std::size_t count) : samples_(samples), count_(count) {
        for (std::size_t i = 0; i < count; ++i) {
            red_[i] = samples[i].rgb[0];
            green_[i] = samples[i].rgb[1];
            blue_[i] = samples[i].rgb[2];
            weight_[i] = samples[i].weight;
        }
        for (std::size_t i = count; i < N; ++i) red_[i] = green_[i] = blue_[i] = weight_[i] = 0;
    }

    PointColour colour() const {
        Values say = weight_;
        if (count_ > 2) {
            Values values;
            for (std::size_t i = 0; i < N; ++i) values[i] = red_[i] + green_[i] + blue_[i];
            values = distancesFrom(samples_[weightedMedian(values)].rgb);
            const float scale = values[weightedMedian(values)];
            const float width = kTukey * std::max(kLeastScale, 1.4826F * scale);
            say = sayAt(values, width);
            for (int k = 0; k < kIterations; ++k) {
                const auto centre = mean(say);
                if (!centre) break;
                say = sayAt(distancesFrom(*centre), width);
            }
        }
        PointColour out;
        for (std::size_t i = 0; i < count_; ++i) {
            if (!(say[i] > 0)) continue;
            out.sum.add(samples_[i].rgb, say[i]);
            out.seenIn |= 1U << samples_[i].view;
        }
        return out;
    }

  private:
    struct alignas(16) Values : std::array<float, N> {};

    /// The index whose value is the weighted median; of equal values the first index comes first.
    std::size_t weightedMedian(Values values) const {
        for (std::size_t i = 0; i < N; ++i)
            values[i] = i < count_ ? values[i] : std::numeric_limits<float>::infinity();
        // Counting how many are less sorts few values faster than swapping them.
        alignas(16) std::array<int32_t, N> less{};
        for (std::size_t i = 0; i < count_; ++i) {
            const float value = values[i];
            for (std::size_t k = 0; k < N; ++k) less[k] += value < values[k] ? 1 : 0;
        }
        std::array<uint8_t, N> order{}, equal{};
        for (std::size_t i = 0; i < count_; ++i) {
            const auto place = static_cast<std::size_t>(less[i]);
            order[place + equal[place]++] = static_cast<uint8_t>(i);
        }
        float total = 0;
        for (std::size_t i = 0; i < count_; ++i) total += weight_[order[i]];
        float below = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            below += weight_[order[i]];
            if (2 * below >= total) return order[i];
        }
        return order[count_ - 1];
    }

    Values distancesFrom(const std::array<float, 3>& rgb) const {
        Values out;
        for (std::size_t i = 0; i < N; ++i) {
            const float r = red_[i] - rgb[0], g = green_[i] - rgb[1], b = blue_[i] - rgb[2];
            out[i] = std::sqrt((r * r + g * g + b * b) / 3);
        }
        return out;
    }

    /// How much say each sample has at these distances; beyond `width` none.
    Values sayAt(const Values& distances, float width) const {
        Values out;
        for (std::size_t i = 0; i < N; ++i) {
            const float x = distances[i] / width;
            const float inside = std::max(0.0F, 1 - x * x);
            out[i] = weight_[i] * inside * inside;
        }
        return out;
    }

    std::optional<std::array<float, 3>> mean(const Values& say) const {
        float r = 0, g = 0, b = 0, total = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            r += say[i] * red_[i];
            g += say[i] * green_[i];
            b += say[i] * blue_[i];
            total += say[i];
        }
        if (!(total > 0)) return std::nullopt;
        return std::array<float, 3>{r / total, g / total, b / total};
    }

    const ColourSample* samples_;
    std::size_t count_;
    Values red_, green_, blue_, weight_;
};

/// With the smallest multiple of four, from N on, that holds all samples.
template <std::size_t N = 4>
PointColour colourOf(const ColourSample* samples, std::size_t count) {
    if constexpr (N < ObjectModel::kMaxViews) {
        if (count > N) return colourOf<N + 4>(samples, count);
    }
    return Samples<N>(samples, count).colour();
}

}  // namespace

PointColour robustColour(const ColourSample* samples, std::size_t count) {
    return colourOf(samples, count);
}

}  // namespace djpete::texture
