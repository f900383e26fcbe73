#include "djpete/pipeline/stage_times.h"

#include <algorithm>
#include <numeric>

namespace djpete::pipeline {

StageSummary summarise(std::vector<double> samples_ms) {
    StageSummary out;
    if (samples_ms.empty()) return out;
    std::sort(samples_ms.begin(), samples_ms.end());
    const auto rank = [&](double q) {
        return samples_ms[static_cast<std::size_t>(q * static_cast<double>(samples_ms.size() - 1) + 0.5)];
    };
    out.calls = samples_ms.size();
    out.median_ms = rank(0.5);
    out.p95_ms = rank(0.95);
    out.max_ms = samples_ms.back();
    out.total_ms = std::accumulate(samples_ms.begin(), samples_ms.end(), 0.0);
    return out;
}

std::map<std::string, StageSummary> StageTimes::summary() const {
    std::map<std::string, StageSummary> out;
    for (const auto& [stage, samples] : samples_) out[stage] = summarise(samples);
    return out;
}

}  // namespace djpete::pipeline
