#include "detection_noise.h"

#include <algorithm>

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::Vec3;
using map::ObjectObservation;

/// A box that nothing is seen of says little, not nothing.
constexpr double kMostCovered = 0.9;
/// Information below this is as good as none; keeps matrices regular.
constexpr double kLeastInformation = 1e-4;

double share(const obs::ImageBox& box, const obs::ImageBox& cover) {
    const float width = std::min(box.right, cover.right) - std::max(box.left, cover.left);
    const float height = std::min(box.bottom, cover.bottom) - std::max(box.top, cover.top);
    if (width <= 0 || height <= 0 || box.area() <= 0) return 0;
    return static_cast<double>(width * height / box.area());
}

/// Covered by the one nearer box that covers most of it.
double covered(const ObjectObservation& o, const std::vector<ObjectObservation>& all) {
    double most = 0;
    if (!o.box) return most;
    const double range_m = o.T_cam_obj.translation().norm();
    for (const auto& other : all) {
        if (&other == &o || !other.box) continue;
        if (other.T_cam_obj.translation().norm() < range_m) {
            most = std::max(most, share(*o.box, *other.box));
        }
    }
    return std::min(most, kMostCovered);
}

}  // namespace

void widen(std::vector<ObjectObservation>& detections, const AssociationOptions& options) {
    std::vector<double> hidden;
    for (const auto& o : detections) hidden.push_back(covered(o, detections));
    for (std::size_t i = 0; i < detections.size(); ++i) {
        auto& o = detections[i];
        const Vec3 p_cam = o.T_cam_obj.translation();
        const double range_m = p_cam.norm();
        const double scale = 1 + options.occlusionNoise * hidden[i] / (1 - hidden[i]);
        const double sigma_m = options.rangeSigma * range_m;
        if (scale <= 1 && sigma_m <= 0) continue;
        // In the direction of sight, by the matrix inversion lemma: what is known of nothing stays
        // unknown.
        o.information /= scale;
        if (range_m <= 0) continue;
        geometry::Vec6 sight = geometry::Vec6::Zero();
        sight.head<3>() = sigma_m * (o.T_cam_obj.rotation().transpose() * (p_cam / range_m));
        const geometry::Vec6 seen = o.information * sight;
        o.information -= seen * seen.transpose() / (1 + sight.dot(seen));
        o.information = 0.5 * (o.information + o.information.transpose()).eval();
        o.information.diagonal() = o.information.diagonal().cwiseMax(kLeastInformation);
    }
}

}  // namespace djpete::backend
