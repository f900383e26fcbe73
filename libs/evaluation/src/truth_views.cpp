#include "truth_views.h"

#include <algorithm>

#include "djpete/obs/errors.h"

namespace djpete::evaluation {

MaskImage TruthViews::mask(int64_t actor, std::size_t frame) {
    constexpr std::size_t kMostKept = 200;
    auto found = instances_.find(frame);
    if (found == instances_.end()) {
        if (instances_.size() >= kMostKept) instances_.clear();
        const std::string file = truth_.instanceFile(frame);
        InstanceImage image = readInstances(file);
        if (image.width_px != truth_.camera.width_px ||
            image.height_px != truth_.camera.height_px) {
            throw obs::InputError(file + ": expected the size of the images of the drive");
        }
        found = instances_.emplace(frame, std::move(image)).first;
    }
    return maskOf(found->second, actor);
}

std::optional<TruthView> TruthViews::view(int64_t object, int64_t actor, const TruthMesh& mesh,
                                          std::size_t frame) {
    const auto T_cam_est = estimate_.T_cam_obj(object, frame);
    const auto T_cam_true = truth_.T_cam_obj(actor, frame);
    if (!T_cam_est || !T_cam_true || T_cam_true->translation().z() <= 0) return std::nullopt;
    return TruthView{frame, *T_cam_est, *T_cam_true, mask(actor, frame),
                     viewOfMesh(mesh, truth_.camera, *T_cam_true)};
}

std::vector<std::size_t> TruthViews::heldOutFrames(int64_t object, int64_t actor,
                                                   const TextureCriteria& criteria) {
    std::vector<std::size_t> visible, out;
    const std::size_t end = estimate_.cameras.firstFrame + estimate_.cameras.T_world_cam.size();
    for (std::size_t frame = estimate_.cameras.firstFrame; frame < end; ++frame) {
        const auto T_cam_true = truth_.T_cam_obj(actor, frame);
        if (!T_cam_true || !estimate_.T_cam_obj(object, frame)) continue;
        if (T_cam_true->translation().z() <= 0 ||
            T_cam_true->translation().norm() > criteria.maxRange_m) {
            continue;
        }
        if (area(mask(actor, frame)) < criteria.minPixels) continue;
        visible.push_back(frame);
        if (estimate_.keyframes.count(frame) == 0) out.push_back(frame);
    }
    if (visible.empty()) return {};
    const std::size_t middle = visible[visible.size() / 2];
    const auto distance = [middle](std::size_t f) { return f < middle ? middle - f : f - middle; };
    std::stable_sort(out.begin(), out.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    if (out.size() > criteria.heldOut) out.resize(criteria.heldOut);
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace djpete::evaluation
