/// A loop over rows on several threads; which thread takes which row does not matter to the result.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace djpete::simulator {

/// Calls f(i) for every i in 0..count-1, each once.
template <class F>
void parallelFor(int count, unsigned threads, F&& f) {
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i = next++; i < count; i = next++) f(i);
    };
    std::vector<std::thread> helpers;
    for (unsigned t = 1; t < threads; ++t) helpers.emplace_back(work);
    work();
    for (auto& h : helpers) h.join();
}

}  // namespace djpete::simulator
