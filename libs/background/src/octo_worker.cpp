#include "djpete/background/octo_worker.h"

#include <chrono>

namespace djpete::background {

OctoWorker::OctoWorker(const OctoOptions& options, bool threaded)
    : options_(options), tree_(options), queue_(options.queue_keyframes) {
    if (threaded) thread_ = std::thread([this] { run(); });
}

OctoWorker::~OctoWorker() {
    queue_.close();
    if (thread_.joinable()) thread_.join();
}

bool OctoWorker::wants(mrpt::Clock::time_point stamp) {
    if (last_ && options_.min_period_s > 0) {
        const std::chrono::duration<double> apart = stamp - *last_;
        if (apart.count() >= 0 && apart.count() < options_.min_period_s) {
            ++tooSoon_;
            return false;
        }
    }
    last_ = stamp;
    return true;
}

void OctoWorker::push(texture::TextureView view) {
    if (!thread_.joinable()) {
        work(view);
    } else if (options_.when_full == "wait") {
        queue_.push(std::move(view));
    } else if (!queue_.tryPush(std::move(view))) {
        ++skipped_;
    }
}

void OctoWorker::finish(const map::SlamMap& map) {
    if (finished_) return;
    finished_ = true;
    queue_.close();
    if (thread_.joinable()) thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    tree_.finish(map);
}

backend::StageTimes OctoWorker::times() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return times_;
}

std::map<std::string, uint64_t> OctoWorker::counters() const {
    std::map<std::string, uint64_t> out;
    if (finished_) out = tree_.counters();
    out["octomap keyframes left out by min_period_s"] = tooSoon_;
    if (skipped_ > 0) out["rejected: octomap keyframes, queue full"] = skipped_;
    return out;
}

void OctoWorker::work(const texture::TextureView& view) {
    if (failure_) return;
    const auto start = std::chrono::steady_clock::now();
    try {
        tree_.addView(view);
    } catch (...) {
        failure_ = std::current_exception();
    }
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    const std::lock_guard<std::mutex> lock(mutex_);
    times_.add(took.count());
}

void OctoWorker::run() {
    while (const auto view = queue_.pop()) work(*view);
}

}  // namespace djpete::background
