#include "djpete/texture/background_cloud.h"

#include <algorithm>

#include "djpete/geometry/cuboid.h"
#include "djpete/texture/background_points.h"
#include "voxel_key.h"

namespace djpete::texture {

namespace {

using geometry::SE3;
using geometry::Vec3;

bool onAnyObject(const Vec3& p_world, const TextureView& view, double margin_m) {
    for (const auto& object : view.objects) {
        const Vec3 apart = p_world - object.T_world_obj.translation();
        if (apart.norm() > 0.5 * object.size_m.norm() + 2 * margin_m) continue;
        const Vec3 p_obj = object.T_world_obj.rotation().transpose() * apart;
        if (geometry::Cuboid{object.size_m}.contains(p_obj, margin_m)) return true;
    }
    return false;
}

ColouredPoint carried(const ColouredPoint& p, const SE3& T_world_vehicle) {
    const Vec3 p_world = T_world_vehicle * Vec3(p.x, p.y, p.z);
    return {static_cast<float>(p_world.x()), static_cast<float>(p_world.y()),
            static_cast<float>(p_world.z()), p.rgb};
}

}  // namespace

BackgroundCloud::BackgroundCloud(const BackgroundCloudOptions& options) : options_(options) {}

std::size_t BackgroundCloud::addView(const TextureView& view) {
    const auto candidates = viewPoints(
        view, {options_.max_distance_m, options_.stereo_max_distance_m, /*unseen*/ false});
    auto& mine = views_[view.frame];
    mine.T_world_vehicle = view.T_world_vehicle;
    const SE3 T_vehicle_cam = view.T_world_vehicle.inverse() * view.T_world_cam;
    std::vector<uint64_t> fresh;
    std::vector<std::pair<uint64_t, std::size_t>> order;  // voxel, candidate
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Vec3 p_world = view.T_world_cam * candidates[i].p_cam;
        const auto key = voxelKey(p_world, options_.voxel_m);
        if (!key || std::binary_search(occupied_.begin(), occupied_.end(), *key)) continue;
        if (onAnyObject(p_world, view, options_.object_margin_m)) continue;
        order.emplace_back(*key, i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [key, i] : order) {
        if (count_ >= options_.max_points) break;
        if (!fresh.empty() && fresh.back() == key) continue;
        fresh.push_back(key);
        const Vec3 p = T_vehicle_cam * candidates[i].p_cam;
        const ColouredPoint point{static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z()), candidates[i].rgb};
        mine.p_vehicle.push_back(point);
        ++count_;
    }
    const auto middle = static_cast<std::ptrdiff_t>(occupied_.size());
    occupied_.insert(occupied_.end(), fresh.begin(), fresh.end());
    std::inplace_merge(occupied_.begin(), occupied_.begin() + middle, occupied_.end());
    return fresh.size();
}

std::vector<ColouredPoint> BackgroundCloud::points(const map::SlamMap& map) const {
    std::vector<ColouredPoint> out;
    out.reserve(count_);
    for (const auto& [frame, view] : views_) {
        SE3 T_world_vehicle = view.T_world_vehicle;
        if (const auto T_world_cam = map.cameraAt(frame)) {
            const auto& keyframe = map.keyframes().at(map.frames().at(frame).reference);
            T_world_vehicle = *T_world_cam * keyframe.T_vehicle_cam.inverse();
        }
        for (const auto& p : view.p_vehicle) out.push_back(carried(p, T_world_vehicle));
    }
    return out;
}

std::vector<ColouredPoint> BackgroundCloud::points() const { return points(map::SlamMap()); }

}  // namespace djpete::texture
