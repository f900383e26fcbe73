#include "djpete/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace djpete::evaluation {

std::optional<double> quantile(std::vector<double> samples, double fraction) {
    if (samples.empty()) return std::nullopt;
    std::sort(samples.begin(), samples.end());
    const double position = fraction * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(position));
    const auto above = std::min(below + 1, samples.size() - 1);
    return samples[below] + (position - std::floor(position)) * (samples[above] - samples[below]);
}

Summary summarise(const std::vector<double>& samples) {
    Summary s;
    s.count = samples.size();
    if (samples.empty()) return s;
    s.median = quantile(samples, 0.5);
    s.p90 = quantile(samples, 0.9);
    s.mean =
        std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
    return s;
}

}  // namespace djpete::evaluation
