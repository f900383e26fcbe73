#include "texture_poses.h"

#include <algorithm>

namespace djpete::evaluation {

std::optional<geometry::SE3> poseByBestView(const texture::ObjectModel& model, int64_t object,
                                            int64_t actor, const EstimatedDrive& estimate,
                                            const TrueDrive& truth) {
    std::optional<geometry::SE3> out;
    std::size_t best = 0;
    for (std::size_t k = 0; k < model.views.size(); ++k) {
        const auto T_cam_est = estimate.T_cam_obj(object, model.views[k].value);
        const auto T_cam_true = truth.T_cam_obj(actor, model.views[k].value);
        if (!T_cam_est || !T_cam_true) continue;
        const auto count = static_cast<std::size_t>(
            std::count_if(model.seenIn.begin(), model.seenIn.end(),
                          [k](uint32_t bits) { return ((bits >> k) & 1U) != 0; }));
        if (out && count <= best) continue;
        best = count;
        out = T_cam_true->inverse() * *T_cam_est;
    }
    return out;
}

std::size_t nearViews(const texture::ObjectModel& model, int64_t actor, const TrueDrive& truth,
                      double maxRange_m) {
    return static_cast<std::size_t>(
        std::count_if(model.views.begin(), model.views.end(), [&](obs::FrameId frame) {
            const auto T = truth.T_cam_obj(actor, frame.value);
            return T && T->translation().norm() <= maxRange_m;
        }));
}

}  // namespace djpete::evaluation
