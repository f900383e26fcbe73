/// A thread of its own for OctoBackground.
#pragma once

#include <mrpt/core/Clock.h>

#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "djpete/backend/channel.h"
#include "djpete/backend/statistics.h"
#include "djpete/background/octo_background.h"

namespace djpete::background {

/// Keyframes go in on the caller's thread and wait in a bounded queue for the worker. With
/// options.when_full = wait the caller waits while it is full, and the result does not depend on
/// timing; with skip the caller never waits. Without a thread (`threaded` false) every keyframe is
/// worked in at once, with the same result as wait.
class OctoWorker {
  public:
    OctoWorker(const OctoOptions& options, bool threaded);
    ~OctoWorker();
    OctoWorker(const OctoWorker&) = delete;
    OctoWorker& operator=(const OctoWorker&) = delete;

    /// Whether a keyframe of this stamp is far enough from the last one that was: ask before
    /// loading images and scan, once per keyframe.
    bool wants(mrpt::Clock::time_point stamp);
    /// A view that cannot be used ends the work; finish() then says why, whatever the timing.
    void push(texture::TextureView view);
    /// Works in what waits, ends the thread and finishes the tree; see OctoBackground::finish.
    /// Throws what a view threw.
    void finish(const map::SlamMap& map);

    /// Only after finish().
    const OctoBackground& tree() const { return tree_; }
    /// Wall times of the worker so far, ms per keyframe.
    backend::StageTimes times() const;
    /// Those of the tree only after finish().
    std::map<std::string, uint64_t> counters() const;

  private:
    void work(const texture::TextureView& view);
    void run();

    OctoOptions options_;
    OctoBackground tree_;
    backend::Channel<texture::TextureView> queue_;
    std::optional<mrpt::Clock::time_point> last_;
    uint64_t skipped_ = 0, tooSoon_ = 0;
    bool finished_ = false;

    std::exception_ptr failure_;  ///< the worker's until it has ended
    mutable std::mutex mutex_;    ///< of times_
    backend::StageTimes times_;
    std::thread thread_;
};

}  // namespace djpete::background
