/// How long each stage of the line took, per call.
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "djpete/backend/statistics.h"

namespace djpete::pipeline {

/// Stage name to its wall times; one table per thread.
using StageTable = std::map<std::string, backend::StageTimes>;

/// Runs `f` and books its wall time under `stage`, also if it throws.
template <class F>
auto measured(StageTable& table, const char* stage, F&& f) {
    struct Booking {
        backend::StageTimes& times;
        std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
        ~Booking() {
            const std::chrono::duration<double, std::milli> dt =
                std::chrono::steady_clock::now() - start;
            times.add(dt.count());
        }
    } booking{table[stage]};
    return f();
}

}  // namespace djpete::pipeline
