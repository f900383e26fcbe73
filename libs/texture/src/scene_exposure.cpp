#include "scene_exposure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "visible_pixel.h"

namespace djpete::texture {

namespace {

using geometry::Vec2;
using geometry::Vec3;

constexpr std::size_t kPoints = 4000, kImages = 3, kLeastCommon = 100;
constexpr float kDarkest = 15, kBrightest = 235;
constexpr double kSigma = 0.02;  // of the logarithm of a ratio

/// How much lenses lose in the corners, as first guess, and how sure that is.
constexpr double kVignettingSigma = 0.05, kRatioSigma = 0.15;

/// The middle one; reorders.
double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Shown {
    float brightness = 0, radius2 = 0;
};

/// Mean of the channels where the image shows p_cam; nothing if it does not, or too dark or bright.
std::optional<Shown> shownAt(const Vec3& p_cam, const ViewImage& image, const DepthMap& scene,
                             const std::vector<BoxOccluder>& boxes) {
    if (p_cam.z() < 1) return std::nullopt;
    const auto uv = visiblePixel(p_cam, image, scene, boxes);
    if (!uv) return std::nullopt;
    const auto rgb = image.sample(*uv);
    if (*std::min_element(rgb.begin(), rgb.end()) < kDarkest ||
        *std::max_element(rgb.begin(), rgb.end()) > kBrightest) {
        return std::nullopt;
    }
    const auto& camera = image.camera;
    const double x = std::max(camera.cx, camera.width_px - 1 - camera.cx);
    const double y = std::max(camera.cy, camera.height_px - 1 - camera.cy);
    const double radius2 = (*uv - Vec2(camera.cx, camera.cy)).squaredNorm() / (x * x + y * y);
    return Shown{(rgb[0] + rgb[1] + rgb[2]) / 3, static_cast<float>(radius2)};
}

}  // namespace

/// From two images alone: how much darker the half of the points became that moved farther outwards
/// than the other half did.
void SceneExposure::learnVignetting(std::vector<Comparison>& seen) {
    const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
    std::nth_element(
        seen.begin(), middle, seen.end(),
        [](const Comparison& a, const Comparison& b) { return a.outwards < b.outwards; });
    const auto middleOf = [](auto begin, auto end, double Comparison::*part) {
        std::vector<double> values;
        for (auto it = begin; it != end; ++it) values.push_back((*it).*part);
        return median(values);
    };
    const double apart = middleOf(middle, seen.end(), &Comparison::outwards) -
                         middleOf(seen.begin(), middle, &Comparison::outwards);
    const double darker = middleOf(middle, seen.end(), &Comparison::logRatio) -
                          middleOf(seen.begin(), middle, &Comparison::logRatio);
    const double weight = static_cast<double>(seen.size()) / (kRatioSigma * kRatioSigma);
    slopes_ += weight * apart * darker;
    slopeWeights_ += weight * apart * apart;
}

std::vector<ExposurePair> SceneExposure::addView(const TextureView& view, const ViewImage& image,
                                                 const ViewGeometry& geometry) {
    std::vector<ExposurePair> pairs;
    const std::vector<BoxOccluder> boxes = allBoxes(view);
    const geometry::SE3 T_cam_world = view.T_world_cam.inverse();
    for (const Past& before : past_) {
        std::vector<Comparison> seen;
        for (const Point& point : before.points) {
            const auto now = shownAt(T_cam_world * point.p_world, image, geometry.scene, boxes);
            if (!now) continue;
            seen.push_back({std::log(static_cast<double>(point.brightness / now->brightness)),
                            static_cast<double>(now->radius2 - point.radius2)});
        }
        if (seen.size() < kLeastCommon) continue;
        learnVignetting(seen);
        const double vignetting =
            slopes_ / (slopeWeights_ + 1 / (kVignettingSigma * kVignettingSigma));
        std::vector<double> logs;
        for (const auto& s : seen) logs.push_back(s.logRatio - vignetting * s.outwards);
        pairs.push_back({before.frame, view.frame, median(logs), 1 / (kSigma * kSigma)});
    }
    Past present;
    present.frame = view.frame;
    const std::size_t step = std::max<std::size_t>(1, geometry.scenePoints_cam.size() / kPoints);
    for (std::size_t i = 0; i < geometry.scenePoints_cam.size(); i += step) {
        const Vec3 p_cam = geometry.scenePoints_cam[i].cast<double>();
        if (const auto shown = shownAt(p_cam, image, geometry.scene, boxes)) {
            present.points.push_back({view.T_world_cam * p_cam, shown->brightness, shown->radius2});
        }
    }
    past_.push_back(std::move(present));
    if (past_.size() > kImages) past_.pop_front();
    return pairs;
}

}  // namespace djpete::texture
