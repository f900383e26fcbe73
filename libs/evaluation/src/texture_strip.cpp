#include "djpete/evaluation/texture_strip.h"

#include <algorithm>
#include <cmath>

#include "djpete/texture/render_model.h"

namespace djpete::evaluation {

namespace {

using Rgb = std::array<uint8_t, 3>;

uint8_t toByte(double x) { return static_cast<uint8_t>(std::lround(std::clamp(x, 0.0, 255.0))); }

Rgb cameraColour(const Rgb& srgb, double gain) {
    Rgb out{};
    const auto light = lightOfAlbedo(srgb);
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = toByte(255 * std::pow(gain * light[c], 1 / kCameraGamma));
    }
    return out;
}

Rgb difference(const Rgb& a, const Rgb& b) {
    Rgb out{};
    for (std::size_t c = 0; c < 3; ++c) out[c] = toByte(128 + (double(a[c]) - double(b[c])));
    return out;
}

}  // namespace

std::optional<RgbImage> textureStrip(const texture::ObjectModel& model, const TruthView& view,
                                     const TruthMesh& mesh, const RgbImage& image,
                                     const geometry::StereoCamera& camera, double albedoGain) {
    constexpr int kBorder_px = 12;
    const MeshView& seen = view.view;
    if (seen.width <= 0 || seen.height <= 0) return std::nullopt;
    const int u0 = std::max(0, seen.x0 - kBorder_px), v0 = std::max(0, seen.y0 - kBorder_px);
    const int u1 = std::min(image.width_px, seen.x0 + seen.width + kBorder_px);
    const int v1 = std::min(image.height_px, seen.y0 + seen.height + kBorder_px);
    const auto rendered = renderModel(model, camera, view.T_cam_est);
    const auto albedo = renderModel(model.withAlbedo(), camera, view.T_cam_est);
    const int w = u1 - u0;
    RgbImage out{6 * w, v1 - v0, {}};
    out.pixels.assign(
        static_cast<std::size_t>(out.width_px) * static_cast<std::size_t>(out.height_px),
        Rgb{255, 255, 255});
    for (int v = v0; v < v1; ++v) {
        for (int u = u0; u < u1; ++u) {
            const std::size_t pixel = image.index(u, v);
            const auto put = [&](int column, const Rgb& colour) {
                out.pixels[out.index(column * w + u - u0, v - v0)] = colour;
            };
            const bool covered = rendered.covered(pixel), masked = view.mask.pixels[pixel] != 0;
            put(0, image.pixels[pixel]);
            if (covered) put(1, rendered.rgb[pixel]);
            const auto at = seen.at(u, v);
            if (at && seen.vertex[*at] != MeshView::kNothing) {
                put(2, cameraColour(mesh.srgb[seen.vertex[*at]], albedoGain));
            }
            put(3, {toByte(covered || masked ? 255 : 0), toByte(masked ? 255 : 0),
                    toByte(masked && !covered ? 255 : 0)});
            if (covered && masked) {
                put(4, difference(rendered.rgb[pixel], image.pixels[pixel]));
            }
            if (albedo.covered(pixel) && !model.albedo.empty()) {
                put(5, cameraColour(albedo.rgb[pixel], albedoGain));
            }
        }
    }
    return out;
}

}  // namespace djpete::evaluation
