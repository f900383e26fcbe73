#include <algorithm>
#include <cmath>
#include <limits>

#include "djpete/evaluation/truth_mesh.h"

namespace djpete::evaluation {

namespace {

constexpr float kNear_m = 0.1F;

/// A vertex in the image.
struct Corner {
    float u, v, z;  ///< z <= kNear_m: not before the camera
};

std::vector<Corner> project(const TruthMesh& mesh, const geometry::StereoCamera& camera,
                            const geometry::SE3& T_cam_obj) {
    std::vector<Corner> out(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const geometry::Vec3 p = T_cam_obj * mesh.point(i);
        if (p.z() <= static_cast<double>(kNear_m)) {
            out[i] = {0, 0, 0};
            continue;
        }
        const geometry::Vec2 uv = camera.project(p);
        out[i] = {static_cast<float>(uv.x()), static_cast<float>(uv.y()),
                  static_cast<float>(p.z())};
    }
    return out;
}

/// The part of the image that holds all corners.
MeshView emptyView(const std::vector<Corner>& corners, const geometry::StereoCamera& camera) {
    float u0 = std::numeric_limits<float>::max(), v0 = u0, u1 = -u0, v1 = -u0;
    for (const auto& c : corners) {
        if (c.z <= kNear_m) continue;
        u0 = std::min(u0, c.u), u1 = std::max(u1, c.u);
        v0 = std::min(v0, c.v), v1 = std::max(v1, c.v);
    }
    const auto pixel = [](float x, int size) {
        return static_cast<int>(std::clamp(std::floor(x), 0.F, static_cast<float>(size)));
    };
    MeshView view;
    if (u0 > u1) return view;
    view.x0 = pixel(u0, camera.width_px);
    view.y0 = pixel(v0, camera.height_px);
    view.width = pixel(u1 + 2, camera.width_px) - view.x0;
    view.height = pixel(v1 + 2, camera.height_px) - view.y0;
    const auto n = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    view.depth_m.assign(n, std::numeric_limits<float>::infinity());
    view.vertex.assign(n, MeshView::kNothing);
    return view;
}

float edge(const Corner& a, const Corner& b, float u, float v) {
    return (b.u - a.u) * (v - a.v) - (b.v - a.v) * (u - a.u);
}

void draw(const std::array<uint32_t, 3>& t, const Corner& a, const Corner& b, const Corner& c,
          MeshView& view) {
    const float area = edge(a, b, c.u, c.v);
    if (area == 0) return;
    const int u0 = std::max(view.x0, static_cast<int>(std::ceil(std::min({a.u, b.u, c.u}))));
    const int v0 = std::max(view.y0, static_cast<int>(std::ceil(std::min({a.v, b.v, c.v}))));
    const int u1 =
        std::min(view.x0 + view.width - 1, static_cast<int>(std::floor(std::max({a.u, b.u, c.u}))));
    const int v1 = std::min(view.y0 + view.height - 1,
                            static_cast<int>(std::floor(std::max({a.v, b.v, c.v}))));
    for (int v = v0; v <= v1; ++v) {
        for (int u = u0; u <= u1; ++u) {
            const auto fu = static_cast<float>(u), fv = static_cast<float>(v);
            const float wa = edge(b, c, fu, fv) / area, wb = edge(c, a, fu, fv) / area;
            const float wc = 1 - wa - wb;
            if (wa < 0 || wb < 0 || wc < 0) continue;
            const float z = 1 / (wa / a.z + wb / b.z + wc / c.z);
            const std::size_t at = *view.at(u, v);
            if (z >= view.depth_m[at]) continue;
            view.depth_m[at] = z;
            view.vertex[at] = wa >= wb && wa >= wc ? t[0] : (wb >= wc ? t[1] : t[2]);
        }
    }
}

}  // namespace

MeshView viewOfMesh(const TruthMesh& mesh, const geometry::StereoCamera& camera,
                    const geometry::SE3& T_cam_obj) {
    const auto corners = project(mesh, camera, T_cam_obj);
    MeshView view = emptyView(corners, camera);
    if (view.width <= 0 || view.height <= 0) return view;
    // Far outside the image a corner would not fit an int.
    const float limit = 1e6F;
    const auto usable = [&](const Corner& c) {
        return c.z > kNear_m && std::abs(c.u) < limit && std::abs(c.v) < limit;
    };
    for (const auto& t : mesh.triangles) {
        const Corner &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
        if (usable(a) && usable(b) && usable(c)) draw(t, a, b, c, view);
    }
    return view;
}

std::vector<bool> verticesSeen(const TruthMesh& mesh, const MeshView& view,
                               const geometry::StereoCamera& camera, const geometry::SE3& T_cam_obj,
                               double minFacing_cos, double maxRange_m) {
    std::vector<bool> seen(mesh.size(), false);
    const geometry::Vec3 camera_obj = T_cam_obj.inverse().translation();
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const geometry::Vec3 towards = camera_obj - mesh.point(i);
        const double range = towards.norm();
        if (range > maxRange_m || range <= 0) continue;
        const double facing = mesh.normal(i).dot(towards) / range;
        if (facing < minFacing_cos) continue;
        const geometry::Vec3 p = T_cam_obj * mesh.point(i);
        if (p.z() <= static_cast<double>(kNear_m)) continue;
        const geometry::Vec2 uv = camera.project(p);
        if (!camera.contains(uv)) continue;
        const auto at =
            view.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y())));
        if (!at) continue;
        // Half a pixel beside the vertex a tilted surface is nearer.
        const double slope = 0.7 * p.z() / camera.fx *
                             std::sqrt(1 - std::min(1.0, facing * facing)) / std::max(facing, 0.1);
        seen[i] = p.z() <= static_cast<double>(view.depth_m[*at]) + 0.02 + slope;
    }
    return seen;
}

}  // namespace djpete::evaluation
