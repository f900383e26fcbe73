#include "djpete/places/place_view.h"

#include <cmath>

namespace djpete::places {

namespace {

struct InverseDepth {
    double sum = 0, weight = 0;  // weighted by 1/sigma^2
    void add(double value, double sigma) {
        if (!(value > 0) || !(sigma > 0)) return;
        sum += value / (sigma * sigma);
        weight += 1 / (sigma * sigma);
    }
};

}  // namespace

PlaceView placeView(const map::Keyframe& keyframe) {
    constexpr double kSigmas = 3;
    PlaceView view;
    view.id = keyframe.id;
    view.camera = keyframe.camera;
    view.corners.reserve(keyframe.features.size());
    const double perDisparity =
        view.camera.hasRight() ? 1 / (view.camera.fx * view.camera.baseline_m) : 0;
    for (std::size_t i = 0; i < keyframe.features.size(); ++i) {
        const obs::KeyframeFeature& f = keyframe.features[i];
        if (!f.descriptor) continue;
        PlaceView::Corner c;
        c.feature = static_cast<uint32_t>(i);
        c.descriptor = *f.descriptor;
        c.px = {f.u_px, f.v_px};
        c.sigma_px = f.sigma_px;
        InverseDepth w;
        if (f.uRight_px && perDisparity > 0) {
            const double disparity =
                static_cast<double>(f.u_px) - static_cast<double>(*f.uRight_px);
            w.add(disparity * perDisparity, f.uRightSigma_px * perDisparity);
        }
        if (f.depth_m) {
            const double z = *f.depth_m;
            w.add(1 / z, static_cast<double>(f.depthSigma_m) / (z * z));
        }
        if (w.weight > 0) {
            const double inverse = w.sum / w.weight;
            c.inverseDepthSigma = 1 / std::sqrt(w.weight);
            if (inverse >= kSigmas * c.inverseDepthSigma) {
                c.p_cam = view.camera.backProject(c.px, 1 / inverse);
            }
        }
        view.corners.push_back(c);
    }
    return view;
}

}  // namespace djpete::places
