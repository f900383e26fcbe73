#include "scan_record.h"

#include <cmath>

#include "djpete/texture/background_points.h"

namespace djpete::background {

namespace {

using geometry::Vec3;

constexpr double kFarthest_m = 130;  // that a stored point can be

/// Which cubes have been taken: open addressing; only membership is asked.
class CubeSet {
  public:
    explicit CubeSet(std::size_t most) {
        std::size_t size = 1024;
        while (size < 2 * most) size *= 2;
        slots_.assign(size, kEmpty);
    }
    /// False if it was there.
    bool insert(uint64_t key) {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> 20U) & mask;
        while (slots_[at] != kEmpty) {
            if (slots_[at] == key) return false;
            at = (at + 1) & mask;
        }
        slots_[at] = key;
        return true;
    }

  private:
    static constexpr uint64_t kEmpty = ~uint64_t{0};
    std::vector<uint64_t> slots_;
};

uint64_t cubeOf(const Vec3& p, double side_m) {
    uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
        const double cell = std::floor(p[i] / side_m) + (1 << 20);
        key = (key << 21U) | static_cast<uint64_t>(cell);
    }
    return key;
}

StoredPoint stored(const Vec3& ray, const texture::ViewPoint& point, bool hit) {
    StoredPoint out;
    for (int i = 0; i < 3; ++i) {
        out.end[static_cast<std::size_t>(i)] =
            static_cast<int16_t>(std::lround(ray[i] / kStoredUnit_m));
    }
    out.flags = hit ? kHit : uint8_t{0};
    if (hit && point.coloured) {
        out.flags = static_cast<uint8_t>(out.flags | kColoured);
        out.rgb = point.rgb;
    }
    return out;
}

}  // namespace

ScanRecord recordOf(const texture::TextureView& view, const OctoOptions& options) {
    const auto points = texture::viewPoints(
        view, {std::numeric_limits<double>::infinity(), options.stereo_max_distance_m, true});
    ScanRecord record;
    record.frame = view.frame;
    record.fromStereo = !view.scan;
    record.T_world_vehicle = view.T_world_vehicle;
    const geometry::SE3 T_vehicle_cam = view.T_world_vehicle.inverse() * view.T_world_cam;
    record.sensor_vehicle =
        view.scan ? view.scan->T_vehicle_velo.translation() : T_vehicle_cam.translation();
    const double reach = std::min(kFarthest_m, options.max_distance_m);
    CubeSet taken(points.size());
    for (const bool coloured : {true, false}) {
        for (const auto& point : points) {
            if (point.coloured != coloured) continue;
            Vec3 ray = T_vehicle_cam * point.p_cam - record.sensor_vehicle;
            const double range = ray.norm();
            if (range < options.min_distance_m) continue;
            const bool hit = range <= options.max_distance_m;
            if (!hit) ray *= reach / range;
            if (!taken.insert(cubeOf(ray, options.decimation_m))) continue;
            record.points.push_back(stored(ray, point, hit));
        }
    }
    record.points.shrink_to_fit();
    return record;
}

}  // namespace djpete::background
