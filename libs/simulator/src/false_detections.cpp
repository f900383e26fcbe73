#include "djpete/simulator/false_detections.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "network.h"
#include "noise.h"

namespace djpete::simulator {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr uint32_t kSalt = 0xFA15EU;  // apart from the noise of true detections
constexpr uint32_t kLongest_frames = 3;
constexpr double kNearest_m = 5;

/// Uniform and normal numbers that are the same on every standard library.
class Dice {
  public:
    explicit Dice(uint32_t seed) : rng_(seed) {}
    double uniform() { return static_cast<double>(rng_()) / 4294967296.0; }
    double uniform(double from, double to) { return from + (to - from) * uniform(); }
    double normal() {
        const double u = 1.0 - uniform();
        return std::sqrt(-2.0 * std::log(u)) * std::cos(2 * M_PI * uniform());
    }

  private:
    std::mt19937 rng_;
};

struct Ghost {
    SE3 T_world_obj;  // box centre, upright
    Vec3 size_m;
    uint32_t lifetime_frames = 1;
};

/// The ghost that is born at a frame in one of the frame's slots.
Ghost bornAt(const World& world, uint64_t frame, uint32_t slot,
             const geometry::StereoCamera& camera, const SE3& T_vehicle_cam, double maxRange_m) {
    Dice dice(hash(world.driveSeed(), static_cast<uint32_t>(frame), slot, kSalt));
    Ghost ghost;
    const double life = dice.uniform();
    ghost.lifetime_frames = life < 5.0 / 6 ? 1 : (life < 11.0 / 12 ? 2 : kLongest_frames);
    ghost.size_m = {dice.uniform(3.4, 4.8), dice.uniform(1.55, 1.9), dice.uniform(1.35, 1.75)};
    const double u = dice.uniform(0.05, 0.95) * camera.width_px;
    const double range = dice.uniform(kNearest_m, std::max(kNearest_m, 0.95 * maxRange_m));
    const double yaw = dice.uniform(-M_PI, M_PI);
    const SE3 T_world_cam = world.T_world_vehicle(frame) * T_vehicle_cam;
    const Vec3 p_world =
        T_world_cam * (range * Vec3((u - camera.cx) / camera.fx, 0, 1).normalized()).eval();
    const double ground = world.network().terrain().height_m(p_world.head<2>());
    ghost.T_world_obj =
        SE3::fromYaw(yaw, {p_world.x(), p_world.y(), ground + 0.5 * ghost.size_m.z()});
    return ghost;
}

/// The box around what the image shows of a ghost; nothing if its middle is out of view.
bool setImageBox(const Ghost& ghost, const SE3& T_cam_obj, const geometry::StereoCamera& camera,
                 Label& l) {
    const Vec3 middle = T_cam_obj.translation();
    if (middle.z() < 1 || !camera.contains(camera.project(middle), -0.5)) return false;
    Vec2 low = camera.project(middle), high = low;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 unit((corner & 1) - 0.5, (corner >> 1 & 1) - 0.5, (corner >> 2 & 1) - 0.5);
        Vec3 p_cam = T_cam_obj * unit.cwiseProduct(ghost.size_m).eval();
        p_cam.z() = std::max(p_cam.z(), 0.1);
        low = low.cwiseMin(camera.project(p_cam));
        high = high.cwiseMax(camera.project(p_cam));
    }
    l.left = std::clamp(low.x(), 0.0, camera.width_px - 1.0);
    l.right = std::clamp(high.x(), 0.0, camera.width_px - 1.0);
    l.top = std::clamp(low.y(), 0.0, camera.height_px - 1.0);
    l.bottom = std::clamp(high.y(), 0.0, camera.height_px - 1.0);
    return true;
}

/// As measured at `frame`; nothing if it is out of view or range there.
std::optional<Detection> measured(const Ghost& ghost, uint64_t frame, uint32_t slot,
                                  const World& world, const geometry::StereoCamera& camera,
                                  const SE3& T_vehicle_cam, const DetectorNoise& noise,
                                  double maxRange_m) {
    Dice dice(hash(world.driveSeed() + 1, static_cast<uint32_t>(frame), slot, kSalt));
    const SE3 T_cam_obj =
        (world.T_world_vehicle(frame) * T_vehicle_cam).inverse() * ghost.T_world_obj;
    Detection d;
    Label& l = d.label;
    if (T_cam_obj.translation().norm() > maxRange_m) return std::nullopt;
    if (!setImageBox(ghost, T_cam_obj, camera, l)) return std::nullopt;
    const Vec3 ahead = T_cam_obj.rotation().col(0);
    const Vec3 bottom = T_cam_obj * Vec3(0, 0, -0.5 * ghost.size_m.z());
    l.frame = frame;
    l.type = nameOf(ActorType::Car);
    l.length_m = ghost.size_m.x();
    l.width_m = ghost.size_m.y();
    l.height_m = ghost.size_m.z();
    // A place that is made up needs noise only when it is measured more than once.
    const double again = ghost.lifetime_frames > 1 ? 1 : 0;
    l.x_m = bottom.x() + again * noise.sigma_m * dice.normal();
    l.y_m = bottom.y() + again * noise.sigma_m * dice.normal();
    l.z_m = bottom.z() + again * noise.sigma_m * dice.normal();
    l.rotationY_rad = std::remainder(
        std::atan2(-ahead.z(), ahead.x()) + again * noise.sigma_rad * dice.normal(), 2 * M_PI);
    l.alpha_rad = std::remainder(l.rotationY_rad - std::atan2(l.x_m, l.z_m), 2 * M_PI);
    d.score = std::clamp(0.5 - 0.005 * l.z_m + 0.15 * dice.normal(), 0.05, 0.95);
    return d;
}

}  // namespace

std::vector<Detection> makeFalseDetections(const World& world, uint64_t frame,
                                           const geometry::StereoCamera& camera,
                                           const SE3& T_vehicle_cam, std::size_t trueRows,
                                           const DetectorNoise& noise, double maxRange_m) {
    std::vector<Detection> out;
    if (noise.falseShare <= 0) return out;
    Dice dice(hash(world.driveSeed(), static_cast<uint32_t>(frame), kSalt));
    const double wanted = static_cast<double>(trueRows) * noise.falseShare / (1 - noise.falseShare);
    const auto slots = static_cast<uint32_t>(std::floor(wanted + dice.uniform()));
    for (uint32_t slot = 0; slot < slots; ++slot) {
        // The eldest that still lives, else the one that is born now.
        std::optional<Detection> shown;
        const auto eldest = std::min<uint64_t>(frame, kLongest_frames - 1);
        for (uint64_t age = eldest + 1; age-- > 0 && !shown;) {
            const Ghost ghost = bornAt(world, frame - age, slot, camera, T_vehicle_cam, maxRange_m);
            if (ghost.lifetime_frames > age)
                shown =
                    measured(ghost, frame, slot, world, camera, T_vehicle_cam, noise, maxRange_m);
        }
        if (shown) out.push_back(*shown);
    }
    return out;
}

}  // namespace djpete::simulator
