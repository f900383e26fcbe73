#include "occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "djpete/geometry/cuboid.h"

namespace djpete::texture {

namespace {

using geometry::SE3;
using geometry::Vec3;

constexpr double kMaxChord_m = 0.15;
constexpr double kPixelMargin = 1.5;  // bilinear samples reach one pixel

/// Where origin + s * direction, s >= 0, enters and leaves the box |x| <= half; equal: nowhere.
std::array<double, 2> sharesInside(const Vec3& origin, const Vec3& direction, const Vec3& half) {
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        if (std::abs(direction[i]) < 1e-12) {
            if (std::abs(origin[i]) > half[i]) return {0, 0};
            continue;
        }
        const double a = (-half[i] - origin[i]) / direction[i];
        const double b = (half[i] - origin[i]) / direction[i];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return {enter, std::max(enter, leave)};
}

/// Share of the line from origin to origin + direction that is inside the box |x| <= half.
double chordShare(const Vec3& origin, const Vec3& direction, const Vec3& half) {
    const auto inside = sharesInside(origin, direction, half);
    return std::max(0.0, std::min(1.0, inside[1]) - inside[0]);
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

std::vector<BoxOccluder> allBoxes(const TextureView& view) {
    constexpr double kMargin_m = 0.1;
    std::vector<BoxOccluder> out;
    for (const auto& object : view.objects) {
        out.emplace_back(view.T_world_cam.inverse() * object.T_world_obj, object.size_m, kMargin_m);
    }
    return out;
}

std::optional<double> entryShare(const Vec3& origin, const Vec3& direction, const Vec3& half) {
    if ((origin.cwiseAbs() - half).maxCoeff() <= 0) return std::nullopt;
    const auto inside = sharesInside(origin, direction, half);
    if (inside[0] >= inside[1]) return std::nullopt;
    return inside[0];
}

}  // namespace djpete::texture
