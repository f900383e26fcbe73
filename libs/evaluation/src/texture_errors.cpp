#include "djpete/evaluation/texture_errors.h"

#include <cmath>

#include "point_grid.h"

namespace djpete::evaluation {

namespace {

constexpr double kMinFacing_cos = 0.2;
constexpr double kBehind_m = 0.25;

geometry::Vec3 toVec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }
std::array<float, 3> toArray(const geometry::Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Coloured points in the true frame.
std::vector<std::array<float, 3>> colouredPoints(const texture::ObjectModel& model,
                                                 const geometry::SE3& T_true_est) {
    std::vector<std::array<float, 3>> out;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (isColoured(model, i)) out.push_back(toArray(T_true_est * toVec(model.point(i))));
    }
    return out;
}

/// Pixel of a point, or nothing outside the image.
std::optional<std::array<int, 2>> pixelOf(const geometry::StereoCamera& camera,
                                          const geometry::Vec3& p_cam) {
    if (p_cam.z() <= 0.1) return std::nullopt;
    const geometry::Vec2 uv = camera.project(p_cam);
    if (!camera.contains(uv)) return std::nullopt;
    return std::array<int, 2>{static_cast<int>(std::lround(uv.x())),
                              static_cast<int>(std::lround(uv.y()))};
}

const TruthView* findView(const std::vector<TruthView>& views, obs::FrameId frame) {
    for (const auto& v : views) {
        if (v.frame == frame.value) return &v;
    }
    return nullptr;
}

bool isWrong(const geometry::Vec3& p_est, const TruthView& view,
             const geometry::StereoCamera& camera) {
    const geometry::Vec3 p_cam = view.T_cam_est * p_est;
    const auto pixel = pixelOf(camera, p_cam);
    if (!pixel || view.mask.at((*pixel)[0], (*pixel)[1]) == 0) return true;
    const auto at = view.view.at((*pixel)[0], (*pixel)[1]);
    return at && p_cam.z() > static_cast<double>(view.view.depth_m[*at]) + kBehind_m;
}

}  // namespace

bool isColoured(const texture::ObjectModel& model, std::size_t point) {
    return model.colours[point].count > 0 &&
           (model.flags[point] & texture::flag::kInferredColour) == 0;
}

std::vector<bool> seenVertices(const TruthMesh& mesh, const std::vector<TruthView>& views,
                               const geometry::StereoCamera& camera, double maxRange_m) {
    std::vector<bool> out(mesh.size(), false);
    for (const auto& view : views) {
        const auto seen =
            verticesSeen(mesh, view.view, camera, view.T_cam_true, kMinFacing_cos, maxRange_m);
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            if (!seen[i] || out[i]) continue;
            const auto pixel = pixelOf(camera, view.T_cam_true * mesh.point(i));
            out[i] = pixel && view.mask.at((*pixel)[0], (*pixel)[1]) != 0;
        }
    }
    return out;
}

Coverage coverageOf(const texture::ObjectModel& model, const geometry::SE3& T_true_est,
                    const TruthMesh& mesh, const std::vector<bool>& seen) {
    const auto points = colouredPoints(model, T_true_est);
    const PointGrid near(points, 0.10), nearer(points, 0.05);
    Coverage out;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (!seen[i]) continue;
        const double a = static_cast<double>(mesh.area_m2[i]);
        out.seen_m2 += a;
        if (nearer.any(mesh.points[i])) {
            out.covered5_m2 += a;
            out.covered10_m2 += a;
        } else if (near.any(mesh.points[i])) {
            out.covered10_m2 += a;
        }
    }
    return out;
}

namespace {

template <class Estimate>
std::vector<ColourPair> pairsWith(const texture::ObjectModel& model,
                                  const geometry::SE3& T_true_est, const TruthMesh& mesh,
                                  const Estimate& estimateOf) {
    const PointGrid grid(mesh.points, 0.15);
    std::vector<ColourPair> out;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!isColoured(model, i)) continue;
        const auto p = toArray(T_true_est * toVec(model.point(i)));
        const geometry::Vec3 n = T_true_est.rotation() * toVec(model.normals[i]);
        const auto vertex =
            grid.nearest(p, [&](uint32_t v) { return mesh.normal(v).dot(n) >= 0.5; });
        if (!vertex) continue;
        out.push_back({estimateOf(i), lightOfAlbedo(mesh.srgb[*vertex]), mesh.normals[*vertex]});
    }
    return out;
}

}  // namespace

std::vector<ColourPair> colourPairs(const texture::ObjectModel& model,
                                    const geometry::SE3& T_true_est, const TruthMesh& mesh) {
    return pairsWith(model, T_true_est, mesh, [&](std::size_t i) {
        const auto& c = model.colours[i].mean;
        return lightOfCamera({c[0], c[1], c[2]});
    });
}

std::vector<ColourPair> albedoPairs(const texture::ObjectModel& model,
                                    const geometry::SE3& T_true_est, const TruthMesh& mesh) {
    if (model.albedo.empty()) return {};
    return pairsWith(model, T_true_est, mesh,
                     [&](std::size_t i) { return lightOfAlbedo(model.albedo[i]); });
}

std::vector<ColourPair> pixelPairs(const RgbImage& image, const TruthView& view,
                                   const TruthMesh& mesh, int step) {
    std::vector<ColourPair> out;
    for (int v = view.view.y0; v < view.view.y0 + view.view.height; v += step) {
        for (int u = view.view.x0; u < view.view.x0 + view.view.width; u += step) {
            const uint32_t vertex = view.view.vertex[*view.view.at(u, v)];
            if (vertex == MeshView::kNothing || view.mask.at(u, v) == 0) continue;
            const auto& c = image.at(u, v);
            out.push_back({lightOfCamera({static_cast<double>(c[0]), static_cast<double>(c[1]),
                                          static_cast<double>(c[2])}),
                           lightOfAlbedo(mesh.srgb[vertex]), mesh.normals[vertex]});
        }
    }
    return out;
}

Bleeding bleedingOf(const texture::ObjectModel& model, const std::vector<TruthView>& views,
                    const geometry::StereoCamera& camera) {
    std::vector<const TruthView*> ofBit;
    for (obs::FrameId frame : model.views) ofBit.push_back(findView(views, frame));
    Bleeding out;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!isColoured(model, i)) continue;
        std::size_t samples = 0, wrong = 0;
        for (std::size_t k = 0; k < ofBit.size(); ++k) {
            if (((model.seenIn[i] >> k) & 1U) == 0 || ofBit[k] == nullptr) continue;
            ++samples;
            if (isWrong(toVec(model.point(i)), *ofBit[k], camera)) ++wrong;
        }
        if (samples == 0) continue;
        out.samples += samples;
        out.wrongSamples += wrong;
        ++out.points;
        if (2 * wrong > samples) ++out.wrongPoints;
    }
    return out;
}

std::optional<double> colourSpread(const texture::ObjectModel& model) {
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!isColoured(model, i) || model.colours[i].count < 2) continue;
        sum += static_cast<double>(model.colours[i].standardDeviation());
        ++n;
    }
    if (n == 0) return std::nullopt;
    return sum / static_cast<double>(n);
}

}  // namespace djpete::evaluation
