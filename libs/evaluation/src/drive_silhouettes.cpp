#include "djpete/evaluation/drive_silhouettes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "djpete/evaluation/statistics.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/overlap.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete/observers/recorded_observer.h"
#include "silhouette_truths.h"

namespace djpete::evaluation {

namespace {

using geometry::SE3;
using geometry::StereoCamera;

obs::RleMask packed(const MaskImage& mask) {
    return obs::RleMask::fromDense(mask.pixels.data(), static_cast<uint32_t>(mask.width_px),
                                   static_cast<uint32_t>(mask.height_px),
                                   static_cast<std::size_t>(mask.width_px));
}

/// A model as it stands in one frame.
struct Placed {
    int64_t id = 0;
    const texture::ObjectModel* model = nullptr;
    SE3 T_cam_obj;
    MaskImage silhouette;  ///< visible part
    obs::ImageBox box;     ///< of the silhouette
    std::size_t wholeArea = 0;
};

class Evaluation {
  public:
    Evaluation(const ObjectModels& models, const EstimatedDrive& estimate,
               const std::string& detections, observers::RecordedObserver observer,
               const SilhouetteCriteria& criteria)
        : models_(models),
          estimate_(estimate),
          file_(detections),
          criteria_(criteria),
          observer_(std::move(observer)) {
        for (const auto& [id, model] : models) choose(id, model);
    }
    void look(const obs::SensorFrame& frame, const StereoCamera& camera);
    DriveSilhouettes finish();

  private:
    void choose(int64_t id, const texture::ObjectModel& model);
    std::vector<Placed> placedIn(std::size_t frame, const StereoCamera& camera) const;
    bool counts(const Placed& placed, std::size_t frame, const StereoCamera& camera);
    void compare(const Placed& placed, std::size_t frame, const StereoCamera& camera,
                 const FrameTruths& truths, const std::optional<std::size_t>& pair);
    bool near(const SE3& T_cam_obj) const {
        return T_cam_obj.translation().norm() <= criteria_.maxRange_m;
    }

    const ObjectModels& models_;
    const EstimatedDrive& estimate_;
    std::string file_;
    SilhouetteCriteria criteria_;
    observers::RecordedObserver observer_;
    std::map<int64_t, ObjectSilhouettes> chosen_;
    DriveSilhouettes out_;
};

void Evaluation::choose(int64_t id, const texture::ObjectModel& model) {
    const auto object = estimate_.objects.find(id);
    if (object == estimate_.objects.end() || !obs::isVehicle(object->second.objectClass)) {
        ++out_.noVehicle;
        return;
    }
    ObjectSilhouettes result;
    result.object = id;
    result.moving = object->second.moving;
    for (const obs::FrameId view : model.views) {
        const auto T_cam_obj = estimate_.T_cam_obj(id, view.value);
        if (T_cam_obj && near(*T_cam_obj)) ++result.nearViews;
    }
    if (result.nearViews < criteria_.minViews) {
        ++out_.fewViews;
        return;
    }
    chosen_.emplace(id, std::move(result));
}

/// All models of the frame with what is visible of them; those of which nothing is are left out.
std::vector<Placed> Evaluation::placedIn(std::size_t frame, const StereoCamera& camera) const {
    std::vector<Placed> out;
    SilhouetteBuffer buffer(camera.width_px, camera.height_px);
    for (const auto& [id, model] : models_) {
        const auto T_cam_obj = estimate_.T_cam_obj(id, frame);
        if (!T_cam_obj || T_cam_obj->translation().z() <= 0) continue;
        const int radius_px =
            std::max(1, static_cast<int>(std::lround(criteria_.gap_m * camera.fx /
                                                     std::max(1.0, T_cam_obj->translation().z()))));
        buffer.add(renderModel(model, camera, *T_cam_obj), radius_px);
        out.push_back({id, &model, *T_cam_obj, {}, {}, 0});
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i].silhouette = buffer.visible(i);
        out[i].wholeArea = buffer.wholeArea(i);
    }
    std::vector<Placed> visible;
    for (auto& placed : out) {
        if (const auto box = boxOf(placed.silhouette)) {
            placed.box = *box;
            visible.push_back(std::move(placed));
        }
    }
    return visible;
}

bool Evaluation::counts(const Placed& placed, std::size_t frame, const StereoCamera& camera) {
    if (chosen_.count(placed.id) == 0 || !near(placed.T_cam_obj)) return false;
    const auto& views = placed.model->views;
    const auto isFrame = [frame](obs::FrameId view) { return view.value == frame; };
    if (std::any_of(views.begin(), views.end(), isFrame)) return false;
    const auto box = projectedBox(estimate_.objects.at(placed.id).size_m, placed.T_cam_obj, camera);
    if (!box || partInImage(*box, camera).area() < criteria_.minInside * box->area()) {
        ++out_.cut;
        return false;
    }
    const std::size_t visible = area(placed.silhouette);
    if (visible < criteria_.minPixels ||
        double(visible) < criteria_.minVisible * double(placed.wholeArea)) {
        ++out_.hidden;
        return false;
    }
    return true;
}

void Evaluation::compare(const Placed& placed, std::size_t frame, const StereoCamera& camera,
                         const FrameTruths& truths, const std::optional<std::size_t>& pair) {
    ObjectSilhouettes& object = chosen_.at(placed.id);
    SilhouetteCase found;
    found.object = placed.id;
    found.frame = frame;
    found.T_cam_obj = placed.T_cam_obj;
    found.silhouette = packed(placed.silhouette);
    if (pair) found.truthBox = truths.vehicles[*pair].box;
    if (pair && !truths.masked) {
        found.boxIou = obs::imageOverlap(placed.box, found.truthBox);
        object.boxed.push_back(std::move(found));
        return;
    }
    if (truths.masked) {
        const MaskImage ignored =
            truths.othersThan(pair, placed.silhouette.width_px, placed.silhouette.height_px);
        found.ignored = packed(ignored);
        if (pair) {
            const MaskImage& mask = truths.vehicles[*pair].mask;
            found.mask = packed(mask);
            found.fit = fitSilhouette(placed.silhouette, mask, ignored);
            const auto cuboid =
                projectedBox(estimate_.objects.at(placed.id).size_m, placed.T_cam_obj, camera);
            if (cuboid)
                found.cuboidIou = obs::imageOverlap(partInImage(*cuboid, camera), found.truthBox);
        }
    }
    (found.fit ? object.masked : object.alone).push_back(std::move(found));
}

void Evaluation::look(const obs::SensorFrame& frame, const StereoCamera& camera) {
    const std::size_t number = frame.id.value;
    if (!estimate_.cameras.contains(number)) return;
    if (estimate_.keyframes.count(number) > 0) {
        ++out_.keyframes;
        return;
    }
    const auto seen = observer_.observe(frame, nullptr, nullptr);
    const auto truths = seen ? truthsOf(*seen, number, camera, file_) : std::nullopt;
    if (!truths) {
        ++out_.framesWithoutTruth;
        return;
    }
    if (seen->detections.empty()) {
        ++out_.framesEmpty;
    } else {
        ++(truths->masked ? out_.framesWithMasks : out_.framesWithBoxes);
    }
    const auto placed = placedIn(number, camera);
    std::vector<obs::ImageBox> boxes, truthBoxes;
    for (const auto& p : placed) boxes.push_back(p.box);
    for (const auto& vehicle : truths->vehicles) {
        truthBoxes.push_back(vehicle.box);
        ++out_.sources[vehicle.detection->source];
    }
    const auto pairs = pairByBoxes(boxes, truthBoxes, criteria_.minOverlap);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (counts(placed[i], number, camera))
            compare(placed[i], number, camera, *truths, pairs[i]);
    }
}

template <class Value>
std::optional<double> medianOf(const std::vector<SilhouetteCase>& cases, const Value& value) {
    std::vector<double> all;
    for (const auto& c : cases) all.push_back(value(c));
    return quantile(all, 0.5);
}

DriveSilhouettes Evaluation::finish() {
    if (out_.framesWithMasks + out_.framesWithBoxes == 0) {
        throw obs::InputError(file_ +
                              ": no mask and no box for any frame that is compared; expected those "
                              "of a network or of labels (the GeometricObserver's come from the "
                              "scans that make the models)");
    }
    for (auto& [id, object] : chosen_) {
        if (object.frames() == 0) {
            ++out_.withoutFrame;
            continue;
        }
        object.iou = medianOf(object.masked, [](const auto& c) { return c.fit->iou; });
        object.cuboidIou =
            medianOf(object.masked, [](const auto& c) { return c.cuboidIou.value_or(0); });
        object.excess = medianOf(object.masked, [](const auto& c) { return c.fit->excess; });
        object.missing = medianOf(object.masked, [](const auto& c) { return c.fit->missing; });
        object.boxIou = medianOf(object.boxed, [](const auto& c) { return *c.boxIou; });
        out_.objects.push_back(std::move(object));
    }
    return std::move(out_);
}

}  // namespace

const SilhouetteCase* ObjectSilhouettes::typical() const {
    const auto value = [](const SilhouetteCase& c) { return c.fit ? c.fit->iou : *c.boxIou; };
    std::vector<const SilhouetteCase*> order;
    for (const auto& c : masked.empty() ? boxed : masked) order.push_back(&c);
    if (order.empty()) return alone.empty() ? nullptr : &alone[alone.size() / 2];
    std::stable_sort(order.begin(), order.end(),
                     [&](const auto* a, const auto* b) { return value(*a) < value(*b); });
    return order[order.size() / 2];
}

std::vector<double> DriveSilhouettes::ious() const {
    std::vector<double> out;
    for (const auto& o : objects) {
        if (o.iou) out.push_back(*o.iou);
    }
    return out;
}

std::vector<double> DriveSilhouettes::boxIous() const {
    std::vector<double> out;
    for (const auto& o : objects) {
        if (o.boxIou) out.push_back(*o.boxIou);
    }
    return out;
}

DriveSilhouettes evaluateSilhouettes(const ObjectModels& models, const EstimatedDrive& estimate,
                                     const std::string& rawlog, const std::string& detections,
                                     const SilhouetteCriteria& criteria) {
    std::error_code none;
    const bool own = std::filesystem::equivalent(rawlog, detections, none);
    Evaluation evaluation(
        models, estimate, detections,
        own ? observers::RecordedObserver() : observers::RecordedObserver(detections), criteria);
    obs::RawlogSource source(rawlog);
    std::optional<StereoCamera> camera;
    if (source.info().gray || source.info().color) {
        camera = source.info().mainCamera(rawlog).model;
    }
    while (const auto frame = source.next()) {
        if (!camera && frame->hasImages()) camera = frame->loadMainImages()->camera.model;
        if (camera) evaluation.look(*frame, *camera);
        frame->unload();
    }
    return evaluation.finish();
}

}  // namespace djpete::evaluation
