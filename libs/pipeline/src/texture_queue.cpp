#include "djpete/pipeline/texture_queue.h"

namespace djpete::pipeline {

namespace {

/// Masks are made in the main camera's image; another camera of the rig sees a car shifted.
bool sameView(const obs::RigCamera& a, const obs::RigCamera& b) {
    const geometry::SE3 T_a_b = a.T_vehicle_cam.inverse() * b.T_vehicle_cam;
    return T_a_b.translation().norm() < 1e-3 && T_a_b.angle_rad() < 1e-4 &&
           a.model.fx == b.model.fx && a.model.cx == b.model.cx && a.model.cy == b.model.cy &&
           a.model.width_px == b.model.width_px && a.model.height_px == b.model.height_px;
}

std::optional<map::ObjectObservation> observationAt(const map::ObjectTrack& object,
                                                    obs::FrameId frame) {
    const auto it = object.observations.find(frame);
    if (it == object.observations.end()) return std::nullopt;
    return it->second;
}

}  // namespace

std::optional<geometry::SE3> mainCameraToObject(const map::SlamMap& map, map::ObjectId object,
                                                obs::FrameId frame) {
    const auto track = map.objects().find(object);
    if (track == map.objects().end()) return std::nullopt;
    const auto seen = track->second.views.find(frame);
    if (seen != track->second.views.end()) return seen->second;
    const auto T_world_cam = map.cameraAt(frame);
    const auto T_world_obj = map.objectPoseAt(object, frame);
    if (!T_world_cam || !T_world_obj) return std::nullopt;
    return T_world_cam->inverse() * *T_world_obj;
}

std::vector<texture::ObjectInView> objectsInView(const map::SlamMap& map, obs::FrameId frame,
                                                 const geometry::SE3& T_world_cam, bool masksFit,
                                                 double range_m) {
    std::vector<texture::ObjectInView> out;
    const geometry::SE3 T_cam_world = T_world_cam.inverse();
    for (const auto& [id, object] : map.objects()) {
        const auto T_main_obj = mainCameraToObject(map, id, frame);
        if (!T_main_obj) continue;
        const geometry::SE3 T_world_obj = *map.cameraAt(frame) * *T_main_obj;
        const geometry::Vec3 p_cam = T_cam_world * T_world_obj.translation();
        const auto seen = observationAt(object, frame);
        if (p_cam.norm() > range_m || (!seen && (object.moving || p_cam.z() < 0))) {
            continue;
        }
        texture::ObjectInView view{id, object.objectClass, object.size_m, T_world_obj, {}};
        if (seen && masksFit) view.mask = seen->mask;
        out.push_back(std::move(view));
    }
    return out;
}

TextureQueue::TextureQueue(const ObjectSlamOptions& options)
    : options_(options.pipeline), texturer_(options.texture), background_(options.background) {}

void TextureQueue::push(const obs::SensorFrame& keyframe) { waiting_.push_back(keyframe); }

void TextureQueue::process(const map::SlamMap& map, bool all, StageTable& times) {
    while (!waiting_.empty() && (all || waiting_.size() > options_.textureLagKeyframes)) {
        const obs::SensorFrame frame = std::move(waiting_.front());
        waiting_.pop_front();
        processView(frame, map, times);
        frame.unload();
    }
}

void TextureQueue::processView(const obs::SensorFrame& frame, const map::SlamMap& map,
                               StageTable& times) {
    const auto T_world_mainCam = map.cameraAt(frame.id);
    const auto images = frame.loadTextureImages();
    const auto mainImages = frame.loadMainImages();
    if (!T_world_mainCam || !images) return;
    texture::TextureView view;
    view.frame = frame.id;
    view.images = *images;
    view.T_world_vehicle = *T_world_mainCam * mainImages->camera.T_vehicle_cam.inverse();
    view.T_world_cam = view.T_world_vehicle * images->camera.T_vehicle_cam;
    view.scan = frame.loadScan();
    const bool masksFit = sameView(images->camera, mainImages->camera);
    view.objects =
        objectsInView(map, frame.id, view.T_world_cam, masksFit, options_.textureRange_m);
    if (options_.texture && !view.objects.empty()) {
        T_main_texture_[frame.id] = T_world_mainCam->inverse() * view.T_world_cam;
        measured(times, "texture", [&] { texturer_.addView(view); });
        measured(times, "texture follows", [&] {
            for (const auto& object : view.objects) {
                texturer_.follow(object.id, posesOf(map, object.id));
            }
        });
    }
    if (options_.background) measured(times, "background", [&] { background_.addView(view); });
}

texture::ObjectTexturer::PoseOf TextureQueue::posesOf(const map::SlamMap& map,
                                                      map::ObjectId object) const {
    return [this, &map, object](obs::FrameId frame) -> std::optional<geometry::SE3> {
        const auto camera = T_main_texture_.find(frame);
        const auto T_main_obj = mainCameraToObject(map, object, frame);
        if (camera == T_main_texture_.end() || !T_main_obj) return std::nullopt;
        return camera->second.inverse() * *T_main_obj;
    };
}

void TextureQueue::finish(const map::SlamMap& map,
                          const std::map<map::ObjectId, map::ObjectId>& joined, unsigned threads) {
    std::vector<map::ObjectId> ids;
    for (const auto& [id, model] : texturer_.models()) ids.push_back(id);
    for (const map::ObjectId id : ids) {
        map::ObjectId home = id;
        for (auto next = joined.find(home); next != joined.end(); next = joined.find(home)) {
            home = next->second;
        }
        if (map.objects().count(home) == 0) {
            texturer_.removeObject(id);
        } else if (home != id) {
            texturer_.mergeObjects(home, id, posesOf(map, home));
        }
    }
    for (const auto& [id, model] : texturer_.models()) {
        texturer_.setSize(id, map.objects().at(id).size_m);
        texturer_.follow(id, posesOf(map, id), true);
    }
    texturer_.settle(threads);
}

}  // namespace djpete::pipeline
