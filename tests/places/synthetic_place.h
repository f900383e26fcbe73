/// Places made of points with random descriptors, seen by a stereo camera with noise.
#pragma once

#include <random>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/places/place_view.h"
#include "djpete_test/synthetic_world.h"

namespace djpete_test {

/// Raw output of the generator only: the same numbers with any library.
class Dice {
  public:
    explicit Dice(uint64_t seed) : engine_(seed) {}
    uint64_t word() { return engine_(); }
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    /// Nearly normal: a sum of twelve uniform numbers.
    double normal(double sigma) {
        double sum = -6;
        for (int i = 0; i < 12; ++i) sum += uniform(0, 1);
        return sigma * sum;
    }

  private:
    std::mt19937_64 engine_;
};

struct PlacePoint {
    Vec3 p_place;
    djpete::obs::Descriptor looks;
};

struct SyntheticPlace {
    explicit SyntheticPlace(uint64_t seed, int count = 500) {
        Dice dice(seed);
        for (int i = 0; i < count; ++i) {
            PlacePoint p;
            p.p_place = {dice.uniform(-15, 15), dice.uniform(-4, 2), dice.uniform(6, 40)};
            for (auto& w : p.looks) w = dice.word();
            points.push_back(p);
        }
    }
    std::vector<PlacePoint> points;
};

struct SightOptions {
    double sigma_px = 0.3;   ///< of a corner, in both images
    double flipped = 0.08;   ///< share of bits that differ from view to view
    double strangers = 0.3;  ///< share of corners that show something else
    double withPoint = 0.8;  ///< share of corners with a stereo match
    uint64_t seed = 1;
};

/// The place seen by a camera at T_place_cam.
inline djpete::places::PlaceView look(const SyntheticPlace& place, const SE3& T_place_cam,
                                      uint64_t id, const SightOptions& options = {}) {
    Dice dice(options.seed * 7919 + id);
    djpete::places::PlaceView view;
    view.id.value = id;
    view.camera = kittiLikeCamera();
    const double perDisparity = 1 / (view.camera.fx * view.camera.baseline_m);
    uint32_t feature = 0;
    for (const auto& point : place.points) {
        const Vec3 p_cam = T_place_cam.inverse() * point.p_place;
        djpete::places::PlaceView::Corner c;
        const bool stranger = dice.uniform(0, 1) < options.strangers;
        const bool hasPoint = dice.uniform(0, 1) < options.withPoint;
        c.descriptor = point.looks;
        for (auto& word : c.descriptor) {
            for (int bit = 0; bit < 64; ++bit) {
                if (dice.uniform(0, 1) < options.flipped) word ^= uint64_t{1} << bit;
            }
            if (stranger) word = dice.word();
        }
        const Vec2 noise(dice.normal(options.sigma_px), dice.normal(options.sigma_px));
        const double depthNoise = dice.normal(options.sigma_px * perDisparity);
        if (p_cam.z() < 1 || !view.camera.contains(view.camera.project(p_cam))) continue;
        c.feature = 3 * feature++;  // features without a descriptor lie between
        c.px = view.camera.project(p_cam) + noise;
        c.sigma_px = options.sigma_px;
        const double inverse = 1 / p_cam.z() + depthNoise;
        c.inverseDepthSigma = options.sigma_px * perDisparity;
        if (hasPoint && inverse > 3 * c.inverseDepthSigma) {
            c.p_cam = view.camera.backProject(c.px, 1 / inverse);
        }
        view.corners.push_back(c);
    }
    return view;
}

}  // namespace djpete_test
