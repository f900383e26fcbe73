#include "colouring.h"

#include <algorithm>
#include <cmath>

#include "djpete/geometry/cuboid.h"

namespace djpete::texture {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kNear_m = 0.3;
constexpr double kMaxChord_m = 0.15;
constexpr double kBorder_px = 1;
constexpr double kPixelMargin = 1.5;  // bilinear samples reach one pixel

/// Distances along origin + s * direction, s in [0, 1], inside the box |x| <= half.
double chordShare(const Vec3& origin, const Vec3& direction, const Vec3& half) {
    double enter = 0, leave = 1;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(direction[i]) < 1e-12) {
            if (std::abs(origin[i]) > half[i]) return 0;
            continue;
        }
        const double a = (-half[i] - origin[i]) / direction[i];
        const double b = (half[i] - origin[i]) / direction[i];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return std::max(0.0, leave - enter);
}

/// A point of the model as the camera sees it.
struct SeenPoint {
    uint32_t index = 0;
    float facingCos = 0;
    Vec2 uv{0, 0};
    Vec3 p_cam{0, 0, 0}, normal_cam{0, 0, 0};
};

/// All points in front of the camera and within or near the image.
std::vector<SeenPoint> project(const ColouringView& view, const ObjectModel& model) {
    std::vector<SeenPoint> out;
    out.reserve(model.size());
    const auto& xs = model.cloud->getPointsBufferRef_x();
    const auto& ys = model.cloud->getPointsBufferRef_y();
    const auto& zs = model.cloud->getPointsBufferRef_z();
    constexpr double kOutside_px = 40;  // their discs may reach in
    for (uint32_t i = 0; i < model.size(); ++i) {
        SeenPoint seen;
        seen.index = i;
        seen.p_cam = view.T_cam_obj * Vec3(xs[i], ys[i], zs[i]);
        if (seen.p_cam.z() < kNear_m) continue;
        seen.uv = view.image.camera.project(seen.p_cam);
        if (!view.image.camera.contains(seen.uv, -kOutside_px)) continue;
        const auto& n = model.normals[i];
        seen.normal_cam = view.T_cam_obj.rotation() * Vec3(n[0], n[1], n[2]);
        seen.facingCos = static_cast<float>(-seen.normal_cam.dot(seen.p_cam) / seen.p_cam.norm());
        out.push_back(seen);
    }
    return out;
}

DepthMap ownSurface(const ColouringView& view, const ObjectModel& model,
                    const std::vector<SeenPoint>& seen) {
    PixelRect rect{view.image.pixels.cols, view.image.pixels.rows, 0, 0};
    for (const auto& s : seen) {
        const int x = static_cast<int>(std::lround(s.uv.x()));
        const int y = static_cast<int>(std::lround(s.uv.y()));
        rect.x0 = std::min(rect.x0, x);
        rect.y0 = std::min(rect.y0, y);
        rect.x1 = std::max(rect.x1, x + 1);
        rect.y1 = std::max(rect.y1, y + 1);
    }
    rect.x0 = std::max(rect.x0, 0);
    rect.y0 = std::max(rect.y0, 0);
    rect.x1 = std::min(rect.x1, view.image.pixels.cols);
    rect.y1 = std::min(rect.y1, view.image.pixels.rows);
    DepthMap own(rect);
    for (const auto& s : seen) {
        own.drawDisc(view.image.camera, s.p_cam, s.normal_cam,
                     static_cast<double>(model.radius_m[s.index]));
    }
    return own;
}

bool visible(const SeenPoint& s, const ColouringView& view, const DepthMap& own,
             const TextureOptions& options) {
    if (static_cast<double>(s.facingCos) < options.min_facing_cos) return false;
    if (!view.image.camera.contains(s.uv, kBorder_px)) return false;
    if (s.p_cam.norm() > options.max_distance_m) return false;
    const int x = static_cast<int>(std::lround(s.uv.x()));
    const int y = static_cast<int>(std::lround(s.uv.y()));
    if (!view.mask.empty() && view.mask.at<uint8_t>(y, x) == 0) return false;
    const double z = s.p_cam.z();
    if (z > static_cast<double>(own.at(x, y)) + options.self_tolerance_m) return false;
    if (z > static_cast<double>(view.scene.at(x, y)) + options.scene_tolerance_m) return false;
    return std::none_of(view.boxes.begin(), view.boxes.end(),
                        [&](const BoxOccluder& box) { return box.hides(s.p_cam); });
}

}  // namespace

bool BoxOccluder::hides(const Vec3& p_cam) const {
    const Vec3& camera_box = T_box_cam_.translation();
    if ((camera_box.cwiseAbs() - half_).maxCoeff() <= 0) return false;
    const Vec3 sight_box = T_box_cam_.rotation() * p_cam;
    const double chord = chordShare(camera_box, sight_box, half_) * sight_box.norm();
    const bool inside = ((camera_box + sight_box).cwiseAbs() - half_).maxCoeff() <= 0;
    return chord > (inside ? kMaxChord_m : 0.0);
}

std::vector<BoxOccluder> occludersOf(const TextureView& view, std::size_t index) {
    std::vector<BoxOccluder> out;
    const SE3 T_cam_world = view.T_world_cam.inverse();
    const auto& own = view.objects[index];
    const Vec3 centre = T_cam_world * own.T_world_obj.translation();
    const double reach = 0.5 * own.size_m.norm();
    for (std::size_t k = 0; k < view.objects.size(); ++k) {
        const auto& other = view.objects[k];
        const SE3 T_cam_other = T_cam_world * other.T_world_obj;
        const Vec3 otherInOwn = own.T_world_obj.inverse() * other.T_world_obj.translation();
        if (k == index || geometry::Cuboid{own.size_m}.contains(otherInOwn)) continue;
        const double otherReach = 0.5 * other.size_m.norm();
        const double distance = centre.norm(), otherDistance = T_cam_other.translation().norm();
        if (otherDistance - otherReach > distance + reach) continue;
        if (distance > reach && otherDistance > otherReach) {
            const double between = std::acos(std::clamp(
                centre.dot(T_cam_other.translation()) / (distance * otherDistance), -1.0, 1.0));
            if (between > std::asin(reach / distance) + std::asin(otherReach / otherDistance)) {
                continue;
            }
        }
        out.emplace_back(T_cam_other, other.size_m,
                         kPixelMargin * otherDistance / view.images.camera.model.fx);
    }
    return out;
}

ViewReport colourObject(const ColouringView& view, const TextureOptions& options,
                        ObjectModel& model) {
    ViewReport report;
    report.pointsProjected = model.size();
    const std::vector<SeenPoint> seen = project(view, model);
    if (seen.empty()) return report;
    const DepthMap own = ownSurface(view, model, seen);
    for (const auto& s : seen) {
        if (!visible(s, view, own, options)) continue;
        const double nearness = std::min(1.0, options.reference_distance_m / s.p_cam.norm());
        ColourSum& sum = model.colours[s.index];
        sum.add(view.image.sample(s.uv), s.facingCos * static_cast<float>(nearness * nearness));
        model.cloud->setPointColor_fast(s.index, sum.mean[0] / 255, sum.mean[1] / 255,
                                        sum.mean[2] / 255);
        ++report.pointsColoured;
    }
    return report;
}

}  // namespace djpete::texture
