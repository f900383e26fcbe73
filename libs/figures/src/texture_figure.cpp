#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "canvas.h"
#include "djpete/texture/render_model.h"
#include "parts.h"

namespace djpete::figures {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr int kWidth_px = 520, kHeight_px = 290;

/// Paints every point of a copy: `colour(i)` in 0..1, nothing: light grey.
template <class ColourOf>
texture::ObjectModel painted(const texture::ObjectModel& model, ColourOf colour) {
    texture::ObjectModel out = model.clone();
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto p = out.point(i);
        const std::optional<std::array<float, 3>> c = colour(i);
        const std::array<float, 3> rgb = c ? *c : std::array<float, 3>{0.8F, 0.8F, 0.8F};
        out.cloud->setPointRGB(i, p[0], p[1], p[2], rgb[0], rgb[1], rgb[2]);
        out.colours[i] = texture::ColourSum();
        out.colours[i].add({255 * rgb[0], 255 * rgb[1], 255 * rgb[2]}, 1);
    }
    return out;
}

cv::Mat rendered(const texture::ObjectModel& model, const VirtualCamera& view) {
    const auto render = texture::renderModel(model, view.model, view.T_cam_base);
    cv::Mat out(kHeight_px, kWidth_px, CV_8UC3, cv::Scalar::all(255));
    for (int v = 0; v < kHeight_px; ++v) {
        for (int u = 0; u < kWidth_px; ++u) {
            const auto pixel = static_cast<std::size_t>(v * kWidth_px + u);
            if (!render.covered(pixel)) continue;
            const auto& c = render.rgb[pixel];
            out.at<cv::Vec3b>(v, u) = cv::Vec3b(c[2], c[1], c[0]);
        }
    }
    return out;
}

VirtualCamera fromSide(const Vec3& size_m, double azimuth_rad) {
    const double distance = 2.1 * size_m.norm();
    const Vec3 eye(distance * std::cos(azimuth_rad), distance * std::sin(azimuth_rad),
                   0.3 * distance);
    return lookingAt(eye, Vec3(0, 0, 0), 16, kWidth_px, kHeight_px);
}

/// Two azimuths, frame obj, from which most coloured points face the eye.
std::vector<double> bestSides(const texture::ObjectModel& model) {
    constexpr int kSides = 12;
    std::array<double, kSides> score{};
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (model.colours[i].count == 0) continue;
        const auto& n = model.normals[i];
        for (std::size_t s = 0; s < kSides; ++s) {
            const double a = (double(s) + 0.5) * 2 * M_PI / kSides;
            score[s] += std::max(0.0, double(n[0]) * std::cos(a) + double(n[1]) * std::sin(a));
        }
    }
    const auto best =
        static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin());
    // The second one at least 60 degrees aside.
    std::size_t second = (best + 2) % kSides;
    for (std::size_t d = 2; d <= kSides - 2; ++d) {
        if (score[(best + d) % kSides] > score[second]) second = (best + d) % kSides;
    }
    return {(double(best) + 0.5) * 2 * M_PI / kSides, (double(second) + 0.5) * 2 * M_PI / kSides};
}

}  // namespace

Figure textureFigure(const texture::ObjectModel& model, const RunResult& result,
                     const ShownFrame* first) {
    std::optional<SE3> T_cam_obj;
    if (first) {
        if (const auto* row = rowOf(result, static_cast<int64_t>(model.id.value), first->frame)) {
            T_cam_obj = first->T_world_cam.inverse() * row->T_world_obj;
        }
    }
    const auto plain = painted(model, [&](std::size_t i) -> std::optional<std::array<float, 3>> {
        // Lit from above and ahead, so that the shape shows.
        const auto& n = model.normals[i];
        const float light = 0.35F + 0.5F * std::max(0.0F, 0.5F * n[0] + 0.4F * n[1] + 0.75F * n[2]);
        return std::array<float, 3>{light, light, light};
    });
    const auto once = painted(model, [&](std::size_t i) -> std::optional<std::array<float, 3>> {
        if ((model.seenIn[i] & 1U) == 0) return std::nullopt;
        if (T_cam_obj) {  // what that image itself shows
            const auto p = model.point(i);
            const Vec3 p_cam = *T_cam_obj * Vec3(p[0], p[1], p[2]);
            if (p_cam.z() < 0.5) return std::nullopt;
            const Vec2 uv = first->camera.project(p_cam);
            if (!first->camera.contains(uv, 1)) return std::nullopt;
            const auto& c =
                first->image.at<cv::Vec3b>(int(std::lround(uv.y())), int(std::lround(uv.x())));
            return std::array<float, 3>{float(c[2]) / 255, float(c[1]) / 255, float(c[0]) / 255};
        }
        const auto& mean = model.colours[i].mean;
        return std::array<float, 3>{mean[0] / 255, mean[1] / 255, mean[2] / 255};
    });
    const auto all = painted(model, [&](std::size_t i) -> std::optional<std::array<float, 3>> {
        if (model.colours[i].count == 0) return std::nullopt;
        const auto& mean = model.colours[i].mean;
        return std::array<float, 3>{mean[0] / 255, mean[1] / 255, mean[2] / 255};
    });
    const std::string id = "Object " + std::to_string(model.id.value);
    std::vector<cv::Mat> rows;
    for (const double side : bestSides(model)) {
        const auto view = fromSide(model.size_m, side);
        std::vector<cv::Mat> panels{rendered(plain, view), rendered(once, view),
                                    rendered(all, view)};
        if (rows.empty()) {
            panels[0] = captioned(panels[0], id + ": points, no texture");
            panels[1] = captioned(panels[1], T_cam_obj ? "First view only (frame " +
                                                             std::to_string(first->frame) + ")"
                                                       : "Points that the first view coloured");
            panels[2] =
                captioned(panels[2], "All " + std::to_string(model.views.size()) + " views");
        }
        rows.push_back(beside(panels));
    }
    return {below(rows), ""};
}

}  // namespace djpete::figures
