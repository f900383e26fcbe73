#include "djpete/backend/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace djpete::backend {

double StageTimes::total_ms() const {
    return std::accumulate(times_ms_.begin(), times_ms_.end(), 0.0);
}

double StageTimes::percentile_ms(double p) const {
    if (times_ms_.empty()) return 0;
    auto sorted = times_ms_;
    std::sort(sorted.begin(), sorted.end());
    const auto n = static_cast<double>(sorted.size());
    const double rank = std::ceil(std::clamp(p, 0.0, 1.0) * n) - 1;
    return sorted[static_cast<std::size_t>(std::max(rank, 0.0))];
}

}  // namespace djpete::backend
