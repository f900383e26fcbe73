#include "djpete/texture/object_texturer.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "albedo.h"
#include "djpete/obs/errors.h"
#include "ground_light.h"
#include "occlusion.h"
#include "parallel_objects.h"
#include "scene_exposure.h"
#include "textured_object.h"
#include "view_geometry.h"
#include "view_image.h"

namespace djpete::texture {

namespace {

// How well an image's gain is known from the scene, and from the image before it.
constexpr double kSceneGainSigma = 1e-4, kBlindGainSigma = 0.2;

}  // namespace

struct ObjectTexturer::Impl {
    explicit Impl(const TextureOptions& o) : options(o) {}

    /// The object, made if there is none.
    TexturedObject& objectOf(map::ObjectId id) {
        const auto it = objects.find(id);
        if (it != objects.end()) return it->second;
        ObjectModel& model = models[id];
        model.id = id;
        return objects.emplace(id, TexturedObject(model, options)).first->second;
    }
    /// How many points the model may have without breaking a limit.
    std::size_t limitFor(const TexturedObject& object) const {
        std::size_t total = 0;
        for (const auto& [id, model] : models) total += model.size();
        const std::size_t room =
            options.max_points_total > total ? options.max_points_total - total : 0;
        return std::min<std::size_t>(options.max_points_per_object, object.model().size() + room);
    }
    ViewReport addView(const TextureView& view, std::size_t k, const ViewImage& image,
                       const ViewGeometry& geometry, const cv::Mat& mask, const cv::Mat& grownMask);
    /// How many points each may have: what is left in all is shared by those with room.
    std::vector<std::size_t> limitsOf(const std::vector<TexturedObject*>& all) const;
    void findExposure(const TextureView& view, const ViewImage& image,
                      const ViewGeometry& geometry);
    void solveExposures(const std::vector<TexturedObject*>& all, unsigned threads);
    void keepWithinMemory();
    void lookAtGround(const TextureView& view, const ViewImage& image, const DepthMap& depth);
    void findAlbedos(unsigned threads);
    std::vector<TexturedObject*> allObjects() {
        std::vector<TexturedObject*> out;
        for (auto& [id, object] : objects) out.push_back(&object);
        return out;
    }

    TextureOptions options;
    std::map<map::ObjectId, ObjectModel> models;  // nodes stay where they are; objects point there
    std::map<map::ObjectId, TexturedObject> objects;
    std::map<map::ObjectId, GroundLight> ground;
    std::map<map::ObjectId, geometry::Mat3> R_world_obj;  // when last seen
    std::map<map::ObjectId, uint64_t> lastSeen;           // the count of views at that time
    uint64_t views = 0;
    ExposureMap exposures;
    SceneExposure scene;
    std::vector<ExposurePair> scenePairs;  // of all images so far
};

namespace {

void requireDistinct(const TextureView& view) {
    std::set<map::ObjectId> seen;
    for (const auto& object : view.objects) {
        if (!seen.insert(object.id).second) {
            throw obs::InputError("frame " + std::to_string(view.frame.value) + ": object " +
                                  std::to_string(object.id.value) +
                                  " is listed twice; expected each object once");
        }
    }
}

std::vector<cv::Mat> masks(const TextureView& view, const ViewImage& image, int border_px) {
    std::vector<cv::Mat> out(view.objects.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const auto& object = view.objects[k];
        if (!object.mask) continue;
        out[k] = denseMask(*object.mask, border_px, image.pixels.size(), view, object.id);
    }
    return out;
}

}  // namespace

ViewReport ObjectTexturer::Impl::addView(const TextureView& view, std::size_t k,
                                         const ViewImage& image, const ViewGeometry& geometry,
                                         const cv::Mat& mask, const cv::Mat& grownMask) {
    const ObjectInView& inView = view.objects[k];
    const bool known = models.count(inView.id) != 0;
    if (!known && geometry.onObject[k].empty()) return {};
    TexturedObject& object = objectOf(inView.id);
    ObjectModel& model = object.model();
    model.objectClass = inView.objectClass;
    model.size_m = inView.size_m;
    lastSeen[inView.id] = views;
    const geometry::SE3 T_cam_obj = view.T_world_cam.inverse() * inView.T_world_obj;
    ViewReport report;
    report.pointsAdded =
        object.insert(geometry.onObject[k], view.frame, T_cam_obj, limitFor(object));
    if (view.scan) carveFreeSpace(view, inView, model.freeSpace);
    const Surroundings around{image, geometry.scene, mask, grownMask, occludersOf(view, k)};
    auto kept = cutView(around, T_cam_obj, model, options);
    if (!kept) return report;
    kept->frame = view.frame;
    report.pointsProjected = model.size();
    report.pointsColoured = object.addView(std::move(*kept));
    return report;
}

std::vector<std::size_t> ObjectTexturer::Impl::limitsOf(
    const std::vector<TexturedObject*>& all) const {
    std::size_t total = 0;
    for (const TexturedObject* object : all) total += object->model().size();
    const std::size_t left =
        options.max_points_total > total ? options.max_points_total - total : 0;
    std::vector<std::size_t> out;
    for (const TexturedObject* object : all) {
        out.push_back(std::min<std::size_t>(options.max_points_per_object,
                                            object->model().size() + left / all.size()));
    }
    return out;
}

/// Of an image whose samples were just taken. The image before it, on the common scale, is the
/// first guess.
void ObjectTexturer::Impl::findExposure(const TextureView& view, const ViewImage& image,
                                        const ViewGeometry& geometry) {
    if (!options.exposure) return;
    Exposure guess;
    const auto before = exposures.lower_bound(view.frame);
    if (before != exposures.begin()) guess = std::prev(before)->second;
    double logs = 0, weights = 0;
    for (const auto& pair : scene.addView(view, image, geometry)) {
        scenePairs.push_back(pair);
        const auto known = exposures.find(pair.a);
        if (known == exposures.end()) continue;
        logs += pair.weight * (std::log(known->second.gain) - pair.logRatio);
        weights += pair.weight;
    }
    if (weights > 0) guess.gain = std::exp(logs / weights);
    ExposureSamples samples;
    for (const auto& inView : view.objects) {
        const auto object = objects.find(inView.id);
        if (object != objects.end()) object->second.collect(view.frame, exposures, samples);
    }
    exposures[view.frame] =
        fitExposure(samples, guess, weights > 0 ? kSceneGainSigma : kBlindGainSigma);
}

/// Gains from all pairs of images at once, then gain and offset of each against the mean of the
/// others. Their means over all images are 1 and 0.
void ObjectTexturer::Impl::solveExposures(const std::vector<TexturedObject*>& all,
                                          unsigned threads) {
    std::vector<std::vector<ExposurePair>> pairsOf(all.size());
    forEachIndex(all.size(), threads, [&](std::size_t i) { all[i]->collect(pairsOf[i]); });
    std::vector<ExposurePair> pairs = scenePairs;
    for (const auto& some : pairsOf) pairs.insert(pairs.end(), some.begin(), some.end());
    std::vector<obs::FrameId> frames;
    for (const auto& [frame, exposure] : exposures) frames.push_back(frame);
    for (const auto& [frame, gain] : solveGains(frames, pairs)) exposures[frame] = {gain, 0};
    std::vector<Exposure> fitted(frames.size());
    forEachIndex(frames.size(), threads, [&](std::size_t f) {
        ExposureSamples samples;
        for (const TexturedObject* object : all) object->collect(frames[f], exposures, samples);
        fitted[f] = fitExposure(samples, exposures.at(frames[f]), kSceneGainSigma);
    });
    double logGain = 0, offset = 0;
    for (const auto& one : fitted) {
        logGain += std::log(one.gain);
        offset += one.offset;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, fitted.size()));
    const double scale = std::exp(-logGain / count);
    for (std::size_t f = 0; f < frames.size(); ++f) {
        exposures[frames[f]] = {fitted[f].gain * scale, fitted[f].offset - offset / count};
    }
}

void ObjectTexturer::Impl::keepWithinMemory() {
    constexpr std::size_t kFewest = 4;
    const std::size_t allowed = options.max_view_mb * 1000000;
    std::size_t bytes = 0;
    for (const auto& [id, object] : objects) bytes += object.viewBytes();
    if (bytes <= allowed) return;
    std::vector<std::pair<uint64_t, map::ObjectId>> order;  // longest unseen first
    for (const auto& [id, when] : lastSeen) order.emplace_back(when, id);
    std::sort(order.begin(), order.end());
    for (const std::size_t most : {kFewest, std::size_t{1}}) {
        for (const auto& [when, id] : order) {
            auto& object = objects.at(id);
            const std::size_t before = object.viewBytes();
            if (object.views().size() <= most) continue;
            object.keepBest(most);
            object.recolour(exposures);
            bytes -= before - object.viewBytes();
            if (bytes <= allowed) return;
        }
    }
}

/// Around all objects that have a model.
void ObjectTexturer::Impl::lookAtGround(const TextureView& view, const ViewImage& image,
                                        const DepthMap& depth) {
    if (!options.albedo) return;
    const std::vector<BoxOccluder> boxes = allBoxes(view);
    for (const auto& inView : view.objects) {
        if (models.count(inView.id) == 0) continue;
        ground[inView.id].addView(view, inView, image, depth, boxes);
        R_world_obj[inView.id] = inView.T_world_obj.rotation();
    }
}

void ObjectTexturer::Impl::findAlbedos(unsigned threads) {
    if (!options.albedo) return;
    std::vector<LitObject> lit;
    for (auto& [id, object] : objects) {
        LitObject one;
        one.model = &object.model();
        one.R_world_obj = R_world_obj[id];
        for (const auto& view : object.views()) {
            const auto known = exposures.find(view.frame);
            if (known != exposures.end()) {
                const auto brightest = known->second.corrected({255, 255, 255});
                one.clipped = std::min(one.clipped, lightOf(brightest, options.camera_gamma)[0]);
            }
            one.cameras_obj.push_back(view.T_cam_obj.inverse().translation());
        }
        one.ring = ground[id].ring(exposures, options.camera_gamma);
        lit.push_back(std::move(one));
    }
    estimateAlbedos(lit, options.camera_gamma, threads);
}

ObjectTexturer::ObjectTexturer(const TextureOptions& options)
    : impl_(std::make_unique<Impl>(options)) {
    if (!(options.camera_gamma >= 0.3 && options.camera_gamma <= 3)) {
        throw obs::InputError("[texture] camera_gamma = " + std::to_string(options.camera_gamma) +
                              ": expected 0.3 to 3");
    }
}
ObjectTexturer::~ObjectTexturer() = default;
ObjectTexturer::ObjectTexturer(ObjectTexturer&&) noexcept = default;
ObjectTexturer& ObjectTexturer::operator=(ObjectTexturer&&) noexcept = default;

ViewReport ObjectTexturer::addView(const TextureView& view) {
    requireDistinct(view);
    const TextureOptions& options = impl_->options;
    // Images without an object still tell of the exposure.
    if (view.objects.empty() && (!options.exposure || view.images.left.isEmpty())) return {};
    const ViewImage image = checkedImage(view);
    const std::vector<cv::Mat> eroded = masks(view, image, options.mask_border_px);
    const std::vector<cv::Mat> grown = masks(view, image, -options.mask_border_px);
    const ViewGeometry geometry = view.scan ? geometryFromScan(view, image, grown, options)
                                            : geometryFromStereo(view, image, eroded, options);
    ++impl_->views;
    ViewReport total;
    for (std::size_t k = 0; k < view.objects.size(); ++k) {
        const ViewReport one = impl_->addView(view, k, image, geometry, eroded[k], grown[k]);
        total.pointsAdded += one.pointsAdded;
        total.pointsProjected += one.pointsProjected;
        total.pointsColoured += one.pointsColoured;
    }
    impl_->findExposure(view, image, geometry);
    impl_->lookAtGround(view, image, geometry.scene);
    for (const auto& inView : view.objects) {
        const auto object = impl_->objects.find(inView.id);
        if (object != impl_->objects.end()) {
            object->second.recolour(impl_->exposures, view.frame);
        }
    }
    impl_->keepWithinMemory();
    return total;
}

bool ObjectTexturer::follow(map::ObjectId object, const PoseOf& T_cam_obj, bool exact) {
    const auto it = impl_->objects.find(object);
    if (it == impl_->objects.end() || !it->second.follow(T_cam_obj, exact)) return false;
    it->second.resample();
    it->second.recolour(impl_->exposures);
    return true;
}

void ObjectTexturer::setSize(map::ObjectId object, const geometry::Vec3& size_m) {
    const auto it = impl_->models.find(object);
    if (it != impl_->models.end()) it->second.size_m = size_m;
}

void ObjectTexturer::settle(unsigned threads) {
    const auto objects = impl_->allObjects();
    const std::vector<std::size_t> limits = impl_->limitsOf(objects);
    forEachIndex(objects.size(), threads, [&](std::size_t i) {
        objects[i]->refine(limits[i]);
        objects[i]->resample();
    });
    if (impl_->options.exposure) impl_->solveExposures(objects, threads);
    forEachIndex(objects.size(), threads,
                 [&](std::size_t i) { objects[i]->recolour(impl_->exposures); });
    impl_->findAlbedos(threads);
    for (TexturedObject* object : objects) object->shrink();
}

const std::map<obs::FrameId, Exposure>& ObjectTexturer::exposures() const {
    return impl_->exposures;
}

std::size_t ObjectTexturer::viewBytes() const {
    std::size_t bytes = 0;
    for (const auto& [id, object] : impl_->objects) bytes += object.viewBytes();
    return bytes;
}

const std::map<map::ObjectId, ObjectModel>& ObjectTexturer::models() const { return impl_->models; }

void ObjectTexturer::removeObject(map::ObjectId object) {
    impl_->objects.erase(object);
    impl_->models.erase(object);
    impl_->lastSeen.erase(object);
    impl_->ground.erase(object);
    impl_->R_world_obj.erase(object);
}

void ObjectTexturer::mergeObjects(map::ObjectId into, map::ObjectId from,
                                  const geometry::SE3& T_into_from) {
    const auto it = impl_->objects.find(from);
    if (into == from || it == impl_->objects.end()) return;
    const bool fresh = impl_->models.count(into) == 0;
    TexturedObject& target = impl_->objectOf(into);
    if (fresh) {
        target.model().objectClass = it->second.model().objectClass;
        target.model().size_m = it->second.model().size_m;
    }
    if (impl_->R_world_obj.count(into) == 0) {
        impl_->R_world_obj[into] = impl_->R_world_obj[from] * T_into_from.rotation().transpose();
    }
    impl_->ground[into].absorb(impl_->ground[from]);
    impl_->lastSeen[into] = std::max(impl_->lastSeen[into], impl_->lastSeen[from]);
    // The points only move, so the total does not grow.
    target.absorb(it->second, T_into_from, impl_->options.max_points_per_object);
    target.recolour(impl_->exposures);
    removeObject(from);
}

void ObjectTexturer::mergeObjects(map::ObjectId into, map::ObjectId from,
                                  const PoseOf& T_cam_into) {
    const auto it = impl_->objects.find(from);
    if (into == from || it == impl_->objects.end()) return;
    for (const auto& view : it->second.views()) {
        if (const auto T = T_cam_into(view.frame)) {
            mergeObjects(into, from, T->inverse() * view.T_cam_obj);
            return;
        }
    }
    removeObject(from);
}

}  // namespace djpete::texture
