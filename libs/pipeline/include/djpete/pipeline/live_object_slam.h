/// SLAM for a running robot: observations in as they come, results out by callback and by value.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "djpete/pipeline/object_slam.h"

namespace djpete::pipeline {

/// How LiveObjectSlam takes its input and hands out its map.
struct LiveOptions {
    /// Frames that may wait for the worker.
    std::size_t queueLength = 4;
    /// When the queue is full: true waits in processObservation() (offline use: every frame
    /// counts), false drops the new frame and counts it (a robot must not be held up).
    bool block = false;
    /// Observations whose stamps differ by at most this are one frame (0: equal stamps).
    double stampSpread_s = 0.0;
    uint64_t firstFrame = 0;        ///< number of the first frame
    std::vector<uint64_t> missing;  ///< numbers to leave out, ascending
    /// The map is copied for snapshot() and callbacks every so many keyframes (0 counts as 1). A
    /// copy takes time and memory in proportion to the whole map.
    unsigned snapshotKeyframes = 1;
    /// The main camera, for drives without images.
    std::optional<obs::RigCamera> rig;
    /// A map of earlier drives (e.g. map::loadMap) to find the place in and to go on from; see
    /// ObjectSlam::continueFrom and FrameOutcome::localised.
    map::MapSnapshot base;
    bool localiseOnly = false;  ///< the poses of `base` stay as they are
};

/// ObjectSlam on a thread of its own. All sensors may call processObservation(), each from its own
/// thread; a frame is complete when an observation of the next one arrives, so observations must
/// come frame after frame. Frames with nothing to follow the vehicle by (no image, recorded
/// keyframe or pose: GPS or IMU between the images) are passed over.
///
/// Several instances may live in one process.
class LiveObjectSlam {
  public:
    /// What a frame gave, and the newest copy of the map (never null; at a keyframe that is copied
    /// it holds that keyframe).
    using FrameCallback = std::function<void(const FrameOutcome&, const map::MapSnapshot&)>;

    /// `observer` is used on the worker's thread only; null means none. Throws obs::InputError if
    /// an option is out of range.
    LiveObjectSlam(const ObjectSlamOptions& options,
                   std::unique_ptr<observers::ObjectObserver> observer, LiveOptions live = {});
    /// Calls shutdown().
    ~LiveObjectSlam();
    LiveObjectSlam(const LiveObjectSlam&) = delete;
    LiveObjectSlam& operator=(const LiveObjectSlam&) = delete;

    /// Hands over an observation; images and scans are loaded later, on the worker's thread, and
    /// must not be changed any more. Returns at once unless `block` is set and the queue is full.
    /// Never throws on bad data (see error()). After an error or shutdown() it does nothing.
    void processObservation(const mrpt::obs::CObservation::Ptr& observation);

    /// Adds a function that is called after each frame, in their order, on the worker's thread and
    /// outside all locks; register it before the first observation to miss none. It may use the
    /// const members of this object except result(), but not processObservation() or shutdown().
    /// What it throws ends processing like bad input.
    void onFrame(FrameCallback callback);

    /// The newest copy of the map (see snapshotKeyframes); after shutdown(), the final one.
    map::MapSnapshot snapshot() const;
    /// The sentence that ended processing, if something did. What came before it is kept.
    std::optional<std::string> error() const;
    /// Frames left out because the queue was full, or because their stamp was not after that of
    /// the frame before.
    uint64_t droppedFrames() const;

    /// Takes the last frame as it is, processes all that waits, runs the last optimisation and ends
    /// the worker. Calling it again does nothing.
    void shutdown();
    /// Map, models and figures. Only after shutdown(); before it, throws std::logic_error.
    const ObjectSlam& result() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::pipeline
