#include "djpete/texture/object_texturer.h"

#include <algorithm>
#include <set>
#include <string>

#include "colouring.h"
#include "djpete/obs/errors.h"
#include "growing_model.h"
#include "view_geometry.h"
#include "view_image.h"

namespace djpete::texture {

struct ObjectTexturer::Impl {
    explicit Impl(const TextureOptions& o) : options(o) {}

    /// The object's model, made if there is none.
    GrowingModel& growing(map::ObjectId id) {
        const auto it = growers.find(id);
        if (it != growers.end()) return it->second;
        ObjectModel& model = models[id];
        model.id = id;
        return growers.emplace(id, GrowingModel(model, options.voxel_m)).first->second;
    }
    /// How many points the model may have without breaking a limit.
    std::size_t limitFor(const GrowingModel& grower) const {
        std::size_t total = 0;
        for (const auto& [id, model] : models) total += model.size();
        const std::size_t room =
            options.max_points_total > total ? options.max_points_total - total : 0;
        return std::min<std::size_t>(options.max_points_per_object, grower.model().size() + room);
    }
    ViewReport texture(const TextureView& view, std::size_t k, const ViewImage& image,
                       const ViewGeometry& geometry, const cv::Mat& mask);

    TextureOptions options;
    std::map<map::ObjectId, ObjectModel> models;  // nodes stay where they are; growers point there
    std::map<map::ObjectId, GrowingModel> growers;
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

void noteView(obs::FrameId frame, ObjectModel& model) {
    const auto at = std::lower_bound(model.views.begin(), model.views.end(), frame);
    if (at == model.views.end() || *at != frame) model.views.insert(at, frame);
}

}  // namespace

ViewReport ObjectTexturer::Impl::texture(const TextureView& view, std::size_t k,
                                         const ViewImage& image, const ViewGeometry& geometry,
                                         const cv::Mat& mask) {
    const ObjectInView& object = view.objects[k];
    const bool known = models.count(object.id) != 0;
    if (!known && geometry.onObject[k].empty()) return {};
    GrowingModel& grower = growing(object.id);
    ObjectModel& model = grower.model();
    model.objectClass = object.objectClass;
    model.size_m = object.size_m;
    const std::size_t added = grower.insert(geometry.onObject[k], limitFor(grower));
    const ColouringView colouring{image, geometry.scene, mask, occludersOf(view, k),
                                  view.T_world_cam.inverse() * object.T_world_obj};
    ViewReport report = colourObject(colouring, options, model);
    report.pointsAdded = added;
    if (report.pointsColoured > 0) noteView(view.frame, model);
    return report;
}

ObjectTexturer::ObjectTexturer(const TextureOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
ObjectTexturer::~ObjectTexturer() = default;
ObjectTexturer::ObjectTexturer(ObjectTexturer&&) noexcept = default;
ObjectTexturer& ObjectTexturer::operator=(ObjectTexturer&&) noexcept = default;

ViewReport ObjectTexturer::addView(const TextureView& view) {
    requireDistinct(view);
    if (view.objects.empty()) return {};
    const TextureOptions& options = impl_->options;
    const ViewImage image = checkedImage(view);
    const std::vector<cv::Mat> eroded = masks(view, image, options.mask_border_px);
    const ViewGeometry geometry =
        view.scan
            ? geometryFromScan(view, image, masks(view, image, -options.mask_border_px), options)
            : geometryFromStereo(view, image, eroded, options);
    ViewReport total;
    for (std::size_t k = 0; k < view.objects.size(); ++k) {
        const ViewReport one = impl_->texture(view, k, image, geometry, eroded[k]);
        total.pointsAdded += one.pointsAdded;
        total.pointsProjected += one.pointsProjected;
        total.pointsColoured += one.pointsColoured;
    }
    return total;
}

const std::map<map::ObjectId, ObjectModel>& ObjectTexturer::models() const { return impl_->models; }

void ObjectTexturer::removeObject(map::ObjectId object) {
    impl_->growers.erase(object);
    impl_->models.erase(object);
}

void ObjectTexturer::mergeObjects(map::ObjectId into, map::ObjectId from,
                                  const geometry::SE3& T_into_from) {
    const auto it = impl_->growers.find(from);
    if (into == from || it == impl_->growers.end()) return;
    const bool fresh = impl_->models.count(into) == 0;
    GrowingModel& target = impl_->growing(into);
    if (fresh) {
        target.model().objectClass = it->second.model().objectClass;
        target.model().size_m = it->second.model().size_m;
    }
    // The points only move, so the total does not grow.
    target.absorb(it->second, T_into_from, impl_->options.max_points_per_object);
    removeObject(from);
}

}  // namespace djpete::texture
