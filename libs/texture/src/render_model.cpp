#include "djpete/texture/render_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "disc.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr double kNear_m = 0.3;
constexpr float kSameSurface_m = 0.10F;

struct Disc {
    uint32_t index = 0;
    float facing = 0;  ///< weight by how much it faces the camera
    DiscInImage shape;
};

std::vector<Disc> discsBefore(const ObjectModel& model, const geometry::StereoCamera& camera,
                              const geometry::SE3& T_cam_obj, const RenderOptions& options) {
    std::vector<Disc> out;
    out.reserve(model.size());
    for (uint32_t i = 0; i < model.size(); ++i) {
        if (options.onlySeen && model.colours[i].count == 0) continue;
        const auto p = model.point(i), n = model.normals[i];
        const Vec3 p_cam = T_cam_obj * Vec3(p[0], p[1], p[2]);
        if (p_cam.z() < kNear_m) continue;
        const Vec3 normal_cam = T_cam_obj.rotation() * Vec3(n[0], n[1], n[2]);
        const double facing = -normal_cam.dot(p_cam) / p_cam.norm();
        if (options.maxTilt_cos > 0 && facing < options.maxTilt_cos) continue;
        out.push_back({i, 0.05F + static_cast<float>(std::max(0.0, facing)),
                       DiscInImage(camera, p_cam.cast<float>(), normal_cam.cast<float>(),
                                   static_cast<float>(options.discScale) * model.radius_m[i])});
    }
    return out;
}

uint8_t toByte(float share) {
    return static_cast<uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

/// Red, green, blue in 0..1 of a point.
std::array<float, 3> colourOf(const ObjectModel& model, uint32_t index) {
    float x = 0, y = 0, z = 0;
    std::array<float, 3> rgb{};
    model.cloud->getPointRGB(index, x, y, z, rgb[0], rgb[1], rgb[2]);
    return rgb;
}

}  // namespace

RenderedModel renderModel(const ObjectModel& model, const geometry::StereoCamera& camera,
                          const geometry::SE3& T_cam_obj, const RenderOptions& options) {
    RenderedModel out;
    out.width_px = camera.width_px;
    out.height_px = camera.height_px;
    const std::size_t pixels =
        static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
    out.rgb.assign(pixels, {0, 0, 0});
    out.depth_m.assign(pixels, std::numeric_limits<float>::infinity());
    out.point.assign(pixels, RenderedModel::kNoPoint);
    const PixelRect all{0, 0, camera.width_px, camera.height_px};
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) +
               static_cast<std::size_t>(x);
    };
    const std::vector<Disc> discs = discsBefore(model, camera, T_cam_obj, options);
    for (const Disc& disc : discs) {
        disc.shape.forPixels(all, [&](int x, int y, float inverseDepth, float) {
            float& stored = out.depth_m[at(x, y)];
            stored = std::min(stored, 1 / inverseDepth);
        });
    }
    // Among the discs at the surface the nearest centre names the pixel; colours are their mean.
    std::vector<float> nearest2(pixels, std::numeric_limits<float>::infinity());
    std::vector<std::array<float, 4>> sums(options.smooth ? pixels : 0, {0, 0, 0, 0});
    for (const Disc& disc : discs) {
        const auto rgb = colourOf(model, disc.index);
        disc.shape.forPixels(all, [&](int x, int y, float inverseDepth, float distance2) {
            const std::size_t k = at(x, y);
            if (1 / inverseDepth > out.depth_m[k] + kSameSurface_m) return;
            if (distance2 < nearest2[k]) {
                nearest2[k] = distance2;
                out.point[k] = disc.index;
            }
            if (!options.smooth) return;
            const float share = 1 - distance2;
            const float weight = disc.facing * (share * share * share + 1e-4F);
            for (std::size_t c = 0; c < 3; ++c) sums[k][c] += weight * rgb[c];
            sums[k][3] += weight;
        });
    }
    for (std::size_t k = 0; k < pixels; ++k) {
        if (!out.covered(k)) continue;
        auto rgb = options.smooth ? std::array<float, 3>{} : colourOf(model, out.point[k]);
        for (std::size_t c = 0; options.smooth && c < 3; ++c) rgb[c] = sums[k][c] / sums[k][3];
        for (std::size_t c = 0; c < 3; ++c) out.rgb[k][c] = toByte(rgb[c]);
    }
    return out;
}

}  // namespace djpete::texture
