/// A function from a problem to its update, on a thread of its own or in the caller's.
#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "djpete/backend/channel.h"

namespace djpete::backend {

/// Lockstep: a job runs in the caller's thread when it is issued. Threaded: on the worker's thread.
/// Results are taken at the same fixed points in both, so both give the same bytes.
enum class Mode { Lockstep, Threaded };

/// Solves jobs one after another. An exception of the function comes back from take(), in place of
/// the result. The owner's destructor joins the thread; jobs not begun are then dropped.
template <class Problem, class Update>
class Worker {
  public:
    using Solve = std::function<Update(const Problem&)>;
    static constexpr std::size_t kCapacity = 4;

    Worker(Solve solve, Mode mode)
        : solve_(std::move(solve)), jobs_(kCapacity), results_(kCapacity) {
        if (mode == Mode::Threaded) thread_ = std::thread([this] { run(); });
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    ~Worker() {
        jobs_.close();
        results_.close();
        if (thread_.joinable()) thread_.join();
    }

    /// At most kCapacity jobs may be under way.
    void issue(Problem problem) {
        if (underWay_ == kCapacity) throw std::logic_error("Worker: too many jobs under way");
        ++underWay_;
        if (thread_.joinable()) {
            jobs_.push(std::move(problem));
        } else {
            results_.push(attempt(problem));
        }
    }
    /// The oldest result not taken yet; waits for it. Rethrows what the function threw.
    Update take() {
        if (underWay_ == 0) throw std::logic_error("Worker: nothing under way");
        --underWay_;
        auto result = results_.pop();
        if (result->error) std::rethrow_exception(result->error);
        return std::move(*result->update);
    }
    std::size_t underWay() const { return underWay_; }

  private:
    struct Result {
        std::optional<Update> update;
        std::exception_ptr error;
    };

    Result attempt(const Problem& problem) {
        try {
            return {solve_(problem), nullptr};
        } catch (...) {
            return {std::nullopt, std::current_exception()};
        }
    }
    void run() {
        while (auto job = jobs_.pop()) {
            if (!results_.push(attempt(*job))) return;
        }
    }

    Solve solve_;
    Channel<Problem> jobs_;
    Channel<Result> results_;
    std::size_t underWay_ = 0;  // owner's thread only
    std::thread thread_;
};

}  // namespace djpete::backend
