#include "ground_light.h"

#include <algorithm>
#include <cmath>

#include "visible_pixel.h"

namespace djpete::texture {

namespace {

using geometry::Vec2;
using geometry::Vec3;
using Rgb = std::array<float, 3>;

constexpr double kNearest_m = 2, kFarthest_m = 25;
constexpr double kOutside_m[] = {0.5, 0.8, 1.2};  // of the box's sides
constexpr int kDirections = 72;
constexpr std::size_t kLeastSamples = 3;  // of a sector in a view
constexpr std::size_t kMostSamples = 60 * kSectors;

/// Where the ray at `angle` from the box's centre leaves the box grown by `outside_m`.
Vec2 onOutline(const Vec3& size_m, double outside_m, double angle) {
    const Vec2 half(0.5 * size_m.x() + outside_m, 0.5 * size_m.y() + outside_m);
    const Vec2 direction(std::cos(angle), std::sin(angle));
    double scale = 1e9;
    for (int i = 0; i < 2; ++i) scale = std::min(scale, half[i] / std::abs(direction[i]));
    return scale * direction;
}

std::optional<Rgb> seenAt(const Vec3& p_cam, const ViewImage& image, const DepthMap& scene,
                          const std::vector<BoxOccluder>& boxes) {
    if (p_cam.z() < kNearest_m || p_cam.z() > kFarthest_m) return std::nullopt;
    const auto uv = visiblePixel(p_cam, image, scene, boxes);
    if (!uv) return std::nullopt;
    return image.sample(*uv);
}

float brightness(const Rgb& rgb) { return rgb[0] + rgb[1] + rgb[2]; }

template <class T, class Less>
T medianOf(std::vector<T>& values, const Less& less) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end(), less);
    return *middle;
}

}  // namespace

void GroundLight::addView(const TextureView& view, const ObjectInView& object,
                          const ViewImage& image, const DepthMap& scene,
                          const std::vector<BoxOccluder>& boxes) {
    const geometry::SE3 T_cam_obj = view.T_world_cam.inverse() * object.T_world_obj;
    std::array<std::vector<Rgb>, kSectors> seen;
    for (int k = 0; k < kDirections; ++k) {
        for (const double outside_m : kOutside_m) {
            const Vec2 at = onOutline(object.size_m, outside_m, 2 * M_PI * (k + 0.5) / kDirections);
            const Vec3 p_obj(at.x(), at.y(), -0.5 * object.size_m.z());
            const auto rgb = seenAt(T_cam_obj * p_obj, image, scene, boxes);
            if (!rgb) continue;
            const Vec3 away = object.T_world_obj.rotation() * Vec3(at.x(), at.y(), 0);
            const double turn = std::atan2(away.y(), away.x()) / (2 * M_PI);  // -0.5 .. 0.5
            const double sector = (turn < 0 ? turn + 1 : turn) * static_cast<double>(kSectors);
            seen[std::min(kSectors - 1, static_cast<std::size_t>(sector))].push_back(*rgb);
        }
    }
    for (std::size_t s = 0; s < kSectors; ++s) {
        if (seen[s].size() < kLeastSamples) continue;
        const Rgb rgb = medianOf(
            seen[s], [](const Rgb& a, const Rgb& b) { return brightness(a) < brightness(b); });
        samples_.push_back({view.frame, static_cast<uint32_t>(s), rgb});
    }
    if (samples_.size() > kMostSamples) {
        samples_.erase(samples_.begin(),
                       samples_.end() - static_cast<std::ptrdiff_t>(kMostSamples));
    }
}

void GroundLight::absorb(const GroundLight& other) {
    samples_.insert(samples_.end(), other.samples_.begin(), other.samples_.end());
}

GroundRing GroundLight::ring(const std::map<obs::FrameId, Exposure>& exposures,
                             double gamma) const {
    std::array<std::vector<Light>, kSectors> lights;
    for (const Sample& sample : samples_) {
        const auto known = exposures.find(sample.frame);
        const Exposure exposure = known == exposures.end() ? Exposure() : known->second;
        lights[sample.sector].push_back(lightOf(exposure.corrected(sample.rgb), gamma));
    }
    GroundRing out;
    for (std::size_t s = 0; s < kSectors; ++s) {
        if (lights[s].empty()) continue;
        out[s] = medianOf(lights[s],
                          [](const Light& a, const Light& b) { return meanOf(a) < meanOf(b); });
    }
    return out;
}

}  // namespace djpete::texture
