/// A loop over rows on several threads; which thread takes which row does not matter to the result.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace djpete::simulator {

/// Calls f(i) for every i in 0..count-1, each once. If calls throw, one of their exceptions is
/// thrown again when all threads have ended.
template <class F>
void parallelFor(int count, unsigned threads, F&& f) {
    std::atomic<int> next{0};
    std::mutex guard;
    std::exception_ptr thrown;
    const auto work = [&] {
        try {
            for (int i = next++; i < count; i = next++) f(i);
        } catch (...) {
            next = count;
            const std::lock_guard<std::mutex> lock(guard);
            thrown = std::current_exception();
        }
    };
    std::vector<std::thread> helpers;
    for (unsigned t = 1; t < threads; ++t) helpers.emplace_back(work);
    work();
    for (auto& h : helpers) h.join();
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace djpete::simulator
