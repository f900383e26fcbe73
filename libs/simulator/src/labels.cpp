#include "djpete/simulator/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <random>

#include "noise.h"
#include "parallel.h"

namespace djpete::simulator {

namespace {

using geometry::SE3;
using geometry::Vec3;

double wrap(double a) { return std::remainder(a, 2 * M_PI); }

/// Share of the car's box, sampled evenly, that the camera's image does not show.
double truncationOf(const Vec3& size_m, const SE3& T_cam_obj,
                    const geometry::StereoCamera& camera) {
    constexpr int kX = 12, kY = 6, kZ = 4;
    int outside = 0;
    for (int i = 0; i < kX * kY * kZ; ++i) {
        const Vec3 unit((i % kX + 0.5) / kX, (i / kX % kY + 0.5) / kY, (i / kX / kY + 0.5) / kZ);
        const Vec3 p = T_cam_obj * (unit - Vec3::Constant(0.5)).cwiseProduct(size_m).eval();
        if (p.z() < 0.1 || !camera.contains(camera.project(p), -0.5)) ++outside;
    }
    return static_cast<double>(outside) / (kX * kY * kZ);
}

}  // namespace

std::vector<Label> makeLabels(Renderer& renderer, const World& world, uint64_t frame,
                              const geometry::StereoCamera& camera, const SE3& T_vehicle_cam,
                              const RenderedImage& image, const LabelOptions& options) {
    std::map<uint32_t, uint32_t> pixels;
    for (uint32_t id : image.actorId) {
        if (id != 0 && id <= options.maxTrackId) ++pixels[id];
    }
    const SE3 T_cam_world = (world.T_world_vehicle(frame) * T_vehicle_cam).inverse();
    std::vector<const Actor*> candidates;
    for (const auto& actor : world.actors()) {
        const auto seen = pixels.find(actor.id);
        if (seen == pixels.end() || seen->second < options.minVisible_px) continue;
        const SE3 T_cam_obj = T_cam_world * world.T_world_obj(actor, frame);
        if (T_cam_obj.translation().norm() <= options.maxRange_m) candidates.push_back(&actor);
    }
    std::vector<std::optional<Label>> labels(candidates.size());
    parallelFor(static_cast<int>(candidates.size()), renderer.threads(), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const Actor& actor = *candidates[at];
        const SE3 T_cam_obj = T_cam_world * world.T_world_obj(actor, frame);
        const auto box = renderer.imageBox(frame, actor, camera, T_vehicle_cam);
        if (!box) return;
        Label& l = labels[at].emplace();
        l.left = std::clamp(box->left, 0.0, camera.width_px - 1.0);
        l.right = std::clamp(box->right, 0.0, camera.width_px - 1.0);
        l.top = std::clamp(box->top, 0.0, camera.height_px - 1.0);
        l.bottom = std::clamp(box->bottom, 0.0, camera.height_px - 1.0);
        l.truncation = truncationOf(actor.size_m, T_cam_obj, camera);
        const Vec3 ahead = T_cam_obj.rotation().col(0);
        const Vec3 bottom = T_cam_obj * Vec3(0, 0, -0.5 * actor.size_m.z());
        l.frame = frame;
        l.trackId = actor.id;
        l.type = nameOf(actor.type);
        l.length_m = actor.size_m.x();
        l.width_m = actor.size_m.y();
        l.height_m = actor.size_m.z();
        l.x_m = bottom.x();
        l.y_m = bottom.y();
        l.z_m = bottom.z();
        l.rotationY_rad = std::atan2(-ahead.z(), ahead.x());
        l.alpha_rad = wrap(l.rotationY_rad - std::atan2(bottom.x(), bottom.z()));
        const double visible = renderer.visibleFraction(frame, actor, T_vehicle_cam);
        l.occlusion = visible > 0.8 ? 0 : (visible > 0.4 ? 1 : 2);
    });
    std::vector<Label> out;
    for (const auto& l : labels)
        if (l) out.push_back(*l);
    return out;
}

std::vector<Detection> makeDetections(const std::vector<Label>& labels, const DetectorNoise& noise,
                                      uint32_t seed) {
    std::vector<Detection> out;
    for (const auto& l : labels) {
        std::mt19937 rng(hash(seed, static_cast<uint32_t>(l.frame), l.trackId));
        const auto uniform = [&] { return static_cast<double>(rng()) / 4294967296.0; };
        // Box-Muller, not std::normal_distribution: the same on every standard library.
        const auto normal = [&] {
            const double u = 1.0 - uniform();
            return std::sqrt(-2.0 * std::log(u)) * std::cos(2 * M_PI * uniform());
        };
        Detection d{l, 0};
        const bool missed = uniform() < noise.missRate;
        d.label.x_m += noise.sigma_m * normal();
        d.label.y_m += noise.sigma_m * normal();
        d.label.z_m += noise.sigma_m * normal();
        d.label.rotationY_rad = wrap(l.rotationY_rad + noise.sigma_rad * normal());
        d.label.alpha_rad = wrap(d.label.rotationY_rad - std::atan2(d.label.x_m, d.label.z_m));
        d.score = std::clamp(1.0 - 0.01 * l.z_m - 0.2 * l.occlusion + 0.05 * normal(), 0.05, 1.0);
        if (!missed) out.push_back(d);
    }
    return out;
}

std::string toKittiRow(const Label& l) {
    char row[320];
    std::snprintf(row, sizeof row,
                  "%llu %u %s %.2f %d %.6f %.4f %.4f %.4f %.4f %.6f %.6f %.6f %.6f %.6f %.6f %.6f",
                  static_cast<unsigned long long>(l.frame), l.trackId, l.type.c_str(), l.truncation,
                  l.occlusion, l.alpha_rad, l.left, l.top, l.right, l.bottom, l.height_m, l.width_m,
                  l.length_m, l.x_m, l.y_m, l.z_m, l.rotationY_rad);
    return row;
}

std::string toPointRcnnRow(const Detection& d) {
    const Label& l = d.label;
    const int type = l.type == "Pedestrian" ? 1 : (l.type == "Cyclist" ? 3 : 2);
    char row[320];
    std::snprintf(
        row, sizeof row, "%llu,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f",
        static_cast<unsigned long long>(l.frame), type, l.left, l.top, l.right, l.bottom, d.score,
        l.height_m, l.width_m, l.length_m, l.x_m, l.y_m, l.z_m, l.rotationY_rad, l.alpha_rad);
    return row;
}

}  // namespace djpete::simulator
