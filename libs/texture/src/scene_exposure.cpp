#include "scene_exposure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "occlusion.h"

namespace djpete::texture {

namespace {

using geometry::Vec2;
using geometry::Vec3;

constexpr std::size_t kPoints = 4000, kImages = 3, kLeastCommon = 100;
constexpr double kBehind_m = 0.3;
constexpr float kDarkest = 15, kBrightest = 235;
constexpr double kSigma = 0.02;  // of the logarithm of a ratio

/// Mean of the channels where the image shows p_cam; nothing if it does not, or too dark or bright.
std::optional<float> brightnessAt(const Vec3& p_cam, const ViewImage& image, const DepthMap& scene,
                                  const std::vector<BoxOccluder>& boxes) {
    if (p_cam.z() < 1) return std::nullopt;
    const Vec2 uv = image.camera.project(p_cam);
    if (!image.camera.contains(uv, 2)) return std::nullopt;
    const double front = static_cast<double>(
        scene.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y()))));
    // Neighbouring beams on sloping ground are a share of the depth apart.
    if (p_cam.z() > 1.05 * front + kBehind_m) return std::nullopt;
    for (const BoxOccluder& box : boxes) {
        if (box.hides(p_cam)) return std::nullopt;
    }
    const auto rgb = image.sample(uv);
    if (*std::min_element(rgb.begin(), rgb.end()) < kDarkest ||
        *std::max_element(rgb.begin(), rgb.end()) > kBrightest) {
        return std::nullopt;
    }
    return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

}  // namespace

std::vector<ExposurePair> SceneExposure::addView(const TextureView& view, const ViewImage& image,
                                                 const ViewGeometry& geometry) {
    std::vector<ExposurePair> pairs;
    const std::vector<BoxOccluder> boxes = allBoxes(view);
    const geometry::SE3 T_cam_world = view.T_world_cam.inverse();
    for (const Past& before : past_) {
        std::vector<double> logs;
        for (const Point& point : before.points) {
            const auto now =
                brightnessAt(T_cam_world * point.p_world, image, geometry.scene, boxes);
            if (now) logs.push_back(std::log(static_cast<double>(point.brightness / *now)));
        }
        if (logs.size() < kLeastCommon) continue;
        const auto middle = logs.begin() + static_cast<std::ptrdiff_t>(logs.size() / 2);
        std::nth_element(logs.begin(), middle, logs.end());
        pairs.push_back({before.frame, view.frame, *middle, 1 / (kSigma * kSigma)});
    }
    Past present;
    present.frame = view.frame;
    const std::size_t step = std::max<std::size_t>(1, geometry.scenePoints_cam.size() / kPoints);
    for (std::size_t i = 0; i < geometry.scenePoints_cam.size(); i += step) {
        const Vec3 p_cam = geometry.scenePoints_cam[i].cast<double>();
        if (const auto brightness = brightnessAt(p_cam, image, geometry.scene, boxes)) {
            present.points.push_back({view.T_world_cam * p_cam, *brightness});
        }
    }
    past_.push_back(std::move(present));
    if (past_.size() > kImages) past_.pop_front();
    return pairs;
}

}  // namespace djpete::texture
