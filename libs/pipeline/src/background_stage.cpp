#include "djpete/pipeline/background_stage.h"

namespace djpete::pipeline {

BackgroundStage::BackgroundStage(const ObjectSlamOptions& options) : options_(options) {
    if (!options.pipeline.octomap) return;
    worker_ = std::make_unique<background::OctoWorker>(options.octomap,
                                                       options.pipeline.mode == "threaded");
}

void BackgroundStage::push(const obs::SensorFrame& keyframe) {
    if (worker_) waiting_.push_back(keyframe);
}

void BackgroundStage::process(const map::SlamMap& map, bool all, bool unload, StageTable& times) {
    while (!waiting_.empty() && (all || waiting_.size() > options_.pipeline.textureLagKeyframes)) {
        const obs::SensorFrame frame = std::move(waiting_.front());
        waiting_.pop_front();
        // With waiting, if the queue is full; without a thread, with the work itself.
        if (worker_->wants(frame.stamp)) {
            measured(times, "octomap, hand over", [&] { handOver(frame, map); });
        }
        if (unload) frame.unload();
    }
}

void BackgroundStage::handOver(const obs::SensorFrame& frame, const map::SlamMap& map) {
    const auto T_world_mainCam = map.cameraAt(frame.id);
    const auto images = frame.loadTextureImages();
    const auto mainImages = frame.loadMainImages();
    if (!T_world_mainCam || !images || !mainImages) return;
    texture::TextureView view;
    view.frame = frame.id;
    view.images = *images;
    // The worker's own: these pixels are let go here.
    view.images.left = images->left.makeDeepCopy();
    if (images->right) view.images.right = images->right->makeDeepCopy();
    view.T_world_vehicle = *T_world_mainCam * mainImages->camera.T_vehicle_cam.inverse();
    view.T_world_cam = view.T_world_vehicle * images->camera.T_vehicle_cam;
    view.scan = frame.loadScan();
    if (view.scan) view.images.right.reset();
    view.objects =
        background::boxesNear(map, frame.id, view.T_world_vehicle, options_.octomap.max_distance_m);
    worker_->push(std::move(view));
}

void BackgroundStage::finish(const map::SlamMap& map, StageTable& times) {
    if (!worker_) return;
    measured(times, "octomap, finish", [&] { worker_->finish(map); });
    finished_ = true;
}

const background::OctoBackground* BackgroundStage::tree() const {
    return finished_ ? &worker_->tree() : nullptr;
}

void BackgroundStage::addTo(StageTable& times) const {
    if (worker_) times["octomap (worker)"] = worker_->times();
}

void BackgroundStage::addTo(std::map<std::string, uint64_t>& counters) const {
    if (!worker_) return;
    for (const auto& [name, count] : worker_->counters()) counters[name] = count;
}

}  // namespace djpete::pipeline
