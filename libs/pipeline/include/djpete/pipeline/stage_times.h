/// How long each stage took, per call.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace djpete::pipeline {

/// Wall times of one stage in milliseconds.
struct StageSummary {
    std::size_t calls = 0;
    double median_ms = 0, p95_ms = 0, max_ms = 0, total_ms = 0;
};

/// Collects samples; one instance per thread.
class StageTimes {
  public:
    /// Runs `f` and books its wall time under `stage`.
    template <class F>
    auto measure(const std::string& stage, F&& f) {
        const Booking booking{*this, stage, std::chrono::steady_clock::now()};
        return f();
    }
    void add(const std::string& stage, double time_ms) { samples_[stage].push_back(time_ms); }
    /// Stage name to summary, in name order.
    std::map<std::string, StageSummary> summary() const;

  private:
    struct Booking {
        StageTimes& times;
        const std::string& stage;
        std::chrono::steady_clock::time_point start;
        ~Booking() {
            const std::chrono::duration<double, std::milli> dt =
                std::chrono::steady_clock::now() - start;
            times.add(stage, dt.count());
        }
    };
    std::map<std::string, std::vector<double>> samples_;
};

/// Summary of samples in any order; all zero if there are none.
StageSummary summarise(std::vector<double> samples_ms);

}  // namespace djpete::pipeline
