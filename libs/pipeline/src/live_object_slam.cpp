#include "djpete/pipeline/live_object_slam.h"

#include <mrpt/core/exceptions.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "djpete/backend/channel.h"
#include "djpete/obs/frame_assembler.h"

namespace djpete::pipeline {

namespace {

bool canBeFollowed(const obs::SensorFrame& frame) {
    return frame.hasImages() || frame.keyframe || frame.T_world_vehicle_truth;
}

}  // namespace

struct LiveObjectSlam::Impl {
    Impl(const ObjectSlamOptions& options, std::unique_ptr<observers::ObjectObserver> observer,
         const LiveOptions& l)
        : live(l),
          slam(options, std::move(observer)),
          frames({l.stampSpread_s, l.firstFrame, l.missing}),
          queue(std::max<std::size_t>(l.queueLength, 1)),
          latest(slam.snapshot()) {
        if (live.rig) slam.setRig(*live.rig);
        if (live.base) {
            slam.continueFrom(*live.base, live.localiseOnly);
            latest = slam.snapshot();
        }
        worker = std::thread([this] { run(); });
        workerId = worker.get_id();
    }

    // The sensors' side.

    void add(const mrpt::obs::CObservation::Ptr& observation) {
        const std::lock_guard<std::mutex> lock(inputMutex);
        if (!open) return;
        if (auto frame = frames.add(observation)) enqueue(std::move(*frame), live.block);
    }

    /// One thread at a time, so that frames enter the queue in their order.
    void enqueue(obs::SensorFrame frame, bool wait) {
        if (!canBeFollowed(frame)) return;
        if (lastStamp && frame.stamp <= *lastStamp) {
            ++dropped;
            return;
        }
        const auto stamp = frame.stamp;
        const bool taken = wait ? queue.push(std::move(frame)) : queue.tryPush(std::move(frame));
        if (taken) {
            lastStamp = stamp;
        } else if (!failed) {
            ++dropped;
        }
    }

    void shutdown() {
        ASSERTMSG_(std::this_thread::get_id() != workerId,
                   "LiveObjectSlam::shutdown() was called by a callback");
        const std::lock_guard<std::mutex> ending(endMutex);
        if (ended) return;
        std::optional<obs::SensorFrame> last;
        {
            const std::lock_guard<std::mutex> lock(inputMutex);
            open = false;  // from here on no other thread enqueues
            last = frames.flush();
        }
        if (last) enqueue(std::move(*last), true);
        queue.close();
        worker.join();
        ended = true;
    }

    // The worker's side.

    void run() {
        attempt([this] {
            while (const auto frame = queue.pop()) process(*frame);
        });
        attempt([this] { slam.finish(); });
        attempt([this] { publish(slam.snapshot()); });
    }

    /// An exception is kept as error(); producers are let go and what still waits is dropped.
    template <class F>
    void attempt(F&& f) {
        try {
            f();
        } catch (const std::exception& e) {
            fail(e.what());
        } catch (...) {
            fail("a callback threw something that is no std::exception");
        }
    }

    void fail(const std::string& sentence) {
        {
            const std::lock_guard<std::mutex> lock(outputMutex);
            if (!error) error = sentence;
        }
        failed = true;
        queue.close();
    }

    void process(const obs::SensorFrame& frame) {
        const FrameOutcome outcome = slam.process(loadFrame(frame));
        const std::size_t keyframes = slam.map().keyframes().size();
        if (keyframes >= nextCopy) {
            publish(slam.snapshot());
            nextCopy = keyframes + std::max(live.snapshotKeyframes, 1U);
        }
        std::vector<FrameCallback> toCall;
        map::MapSnapshot map;
        {
            const std::lock_guard<std::mutex> lock(outputMutex);
            toCall = callbacks;
            map = latest;
        }
        for (const auto& callback : toCall) callback(outcome, map);
    }

    void publish(map::MapSnapshot map) {
        const std::lock_guard<std::mutex> lock(outputMutex);
        latest = std::move(map);
    }

    const LiveOptions live;
    ObjectSlam slam;           ///< the worker's until it has ended
    std::size_t nextCopy = 1;  ///< number of keyframes at which the map is copied next

    std::mutex inputMutex;  ///< guards frames, lastStamp, open
    obs::FrameAssembler frames;
    std::optional<mrpt::Clock::time_point> lastStamp;
    bool open = true;

    backend::Channel<obs::SensorFrame> queue;
    std::atomic<uint64_t> dropped{0};
    std::atomic<bool> failed{false}, ended{false};

    mutable std::mutex outputMutex;  ///< guards latest, error, callbacks
    map::MapSnapshot latest;
    std::optional<std::string> error;
    std::vector<FrameCallback> callbacks;

    std::mutex endMutex;  ///< held by whoever ends the worker
    std::thread worker;
    std::thread::id workerId;
};

LiveObjectSlam::LiveObjectSlam(const ObjectSlamOptions& options,
                               std::unique_ptr<observers::ObjectObserver> observer,
                               LiveOptions live)
    : impl_(std::make_unique<Impl>(options, std::move(observer), live)) {}
LiveObjectSlam::~LiveObjectSlam() { shutdown(); }

void LiveObjectSlam::processObservation(const mrpt::obs::CObservation::Ptr& observation) {
    ASSERTMSG_(observation, "LiveObjectSlam: the observation is null");
    impl_->add(observation);
}

void LiveObjectSlam::onFrame(FrameCallback callback) {
    const std::lock_guard<std::mutex> lock(impl_->outputMutex);
    impl_->callbacks.push_back(std::move(callback));
}

map::MapSnapshot LiveObjectSlam::snapshot() const {
    const std::lock_guard<std::mutex> lock(impl_->outputMutex);
    return impl_->latest;
}

std::optional<std::string> LiveObjectSlam::error() const {
    const std::lock_guard<std::mutex> lock(impl_->outputMutex);
    return impl_->error;
}

uint64_t LiveObjectSlam::droppedFrames() const { return impl_->dropped; }

void LiveObjectSlam::shutdown() { impl_->shutdown(); }

const ObjectSlam& LiveObjectSlam::result() const {
    ASSERTMSG_(impl_->ended, "LiveObjectSlam::result() before shutdown()");
    return impl_->slam;
}

}  // namespace djpete::pipeline
