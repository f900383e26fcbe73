/// Work that goes on beside the caller's, with a bound on how much may wait.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace djpete::simulator {

/// Runs jobs on threads of its own, started in the order in which they came. After a job has thrown
/// no further one is started.
class WriteQueue {
  public:
    WriteQueue(unsigned threads, std::size_t mostWaiting) : mostWaiting_(mostWaiting) {
        for (unsigned t = 0; t < threads; ++t) threads_.emplace_back([this] { work(); });
    }
    /// Jobs that wait are thrown away.
    ~WriteQueue() {
        {
            const std::lock_guard<std::mutex> lock(guard_);
            waiting_.clear();
        }
        end();
    }
    WriteQueue(const WriteQueue&) = delete;
    WriteQueue& operator=(const WriteQueue&) = delete;

    /// Waits until there is room. Throws what a job has thrown.
    void push(std::function<void()> job) {
        std::unique_lock<std::mutex> lock(guard_);
        changed_.wait(lock, [this] { return thrown_ || waiting_.size() < mostWaiting_; });
        if (thrown_) std::rethrow_exception(thrown_);
        waiting_.push_back(std::move(job));
        changed_.notify_all();
    }
    /// Waits for all jobs; none may come after it. Throws what a job has thrown.
    void finish() {
        end();
        if (thrown_) std::rethrow_exception(thrown_);
    }

  private:
    void end() {
        {
            const std::lock_guard<std::mutex> lock(guard_);
            ending_ = true;
            changed_.notify_all();
        }
        for (auto& t : threads_) {
            if (t.joinable()) t.join();
        }
    }
    void work() {
        std::unique_lock<std::mutex> lock(guard_);
        while (true) {
            changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
            if (waiting_.empty() || thrown_) return;
            const auto job = std::move(waiting_.front());
            waiting_.pop_front();
            changed_.notify_all();
            lock.unlock();
            std::exception_ptr thrown;
            try {
                job();
            } catch (...) {
                thrown = std::current_exception();
            }
            lock.lock();
            if (thrown && !thrown_) thrown_ = thrown;
            changed_.notify_all();
        }
    }

    std::size_t mostWaiting_;
    std::mutex guard_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> waiting_;
    std::exception_ptr thrown_;
    bool ending_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace djpete::simulator
