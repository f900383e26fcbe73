/// Keyframes wait here until their poses have settled; then the worker of the octree gets them.
#pragma once

#include <deque>
#include <memory>

#include "djpete/background/octo_worker.h"
#include "djpete/obs/sensor_frame.h"
#include "djpete/pipeline/options.h"
#include "djpete/pipeline/stage_times.h"

namespace djpete::pipeline {

/// Feeds OctoWorker as many keyframes late as TextureQueue is, so that the result depends on the
/// frames only and not on thread timing. Does nothing unless options.pipeline.octomap.
class BackgroundStage {
  public:
    explicit BackgroundStage(const ObjectSlamOptions& options);

    /// A keyframe with its images and scan.
    void push(const obs::SensorFrame& keyframe);
    /// Hands over the views that are old enough (all of them if `all`) with the poses of `map`.
    /// Lets their images and scans go if `unload`; else somebody else does.
    void process(const map::SlamMap& map, bool all, bool unload, StageTable& times);
    /// Waits for the worker and finishes the tree. Throws obs::InputError if a view could not be
    /// used.
    void finish(const map::SlamMap& map, StageTable& times);

    /// Null before finish() and if there is none.
    const background::OctoBackground* tree() const;
    void addTo(StageTable& times) const;
    void addTo(std::map<std::string, uint64_t>& counters) const;

  private:
    void handOver(const obs::SensorFrame& frame, const map::SlamMap& map);

    ObjectSlamOptions options_;
    std::unique_ptr<background::OctoWorker> worker_;
    std::deque<obs::SensorFrame> waiting_;
    bool finished_ = false;
};

}  // namespace djpete::pipeline
