#include "djpete/texture/surface.h"

#include <algorithm>
#include <cmath>

#include "distance_grid.h"
#include "point_grid.h"
#include "surface_nets.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr float kGrey = 255 * ObjectModel::kNeutralGrey;

/// True if a point that faces the same way is within so many of its radii.
std::vector<bool> nearPoints(const ObjectModel& model, const Facets& facets, double radii,
                             double voxel_m) {
    double largest = voxel_m;
    for (const float r : model.radius_m) largest = std::max(largest, static_cast<double>(r));
    largest = std::min(largest, 0.3);
    const PointGrid grid(model, 0.1);
    std::vector<bool> out;
    for (const auto& v : facets.vertices) {
        bool near = false;
        grid.forWithin(v.p_obj, radii * largest, [&](uint32_t i, double d2) {
            const double reach =
                radii * std::max(static_cast<double>(model.radius_m[i]), 0.8 * voxel_m);
            near |= d2 <= reach * reach && v.normal.dot(vec3(model.normals[i])) > 0;
        });
        out.push_back(near);
    }
    return out;
}

class Painter {
  public:
    Painter(const ObjectModel& model, double voxel_m)
        : model_(model),
          coloured_(model, 0.1, [&](uint32_t i) { return model.colours[i].count > 0; }),
          voxel_m_(voxel_m) {}

    /// Of the nearest points that face the same way; grey if there are none.
    std::array<uint8_t, 3> colourAt(const Vec3& p, const Vec3& n) const {
        for (const double reach : {2 * voxel_m_, 4 * voxel_m_}) {
            if (const auto rgb = meanWithin(p, n, reach)) return *rgb;
        }
        return {bytes(kGrey), bytes(kGrey), bytes(kGrey)};
    }

  private:
    static uint8_t bytes(float value) {
        return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
    }

    std::optional<std::array<uint8_t, 3>> meanWithin(const Vec3& p, const Vec3& n,
                                                     double reach_m) const {
        std::array<double, 3> sum{0, 0, 0};
        double total = 0;
        const double spread = reach_m / 4;
        coloured_.forWithin(p, reach_m, [&](uint32_t i, double d2) {
            const double facing = n.dot(vec3(model_.normals[i]));
            if (facing < 0.2) return;
            const double weight = facing * std::exp(-d2 / (2 * spread * spread));
            for (unsigned c = 0; c < 3; ++c) {
                sum[c] += weight * static_cast<double>(model_.colours[i].mean[c]);
            }
            total += weight;
        });
        if (!(total > 0)) return std::nullopt;
        std::array<uint8_t, 3> out{};
        for (unsigned c = 0; c < 3; ++c) out[c] = bytes(static_cast<float>(sum[c] / total));
        return out;
    }

    const ObjectModel& model_;
    PointGrid coloured_;
    double voxel_m_;
};

/// A block per quad: its corners are the middles of the block's corner texels.
MeshAtlas makeAtlas(const Facets& facets, const Painter& painter, uint32_t block_px) {
    MeshAtlas atlas;
    const auto count = static_cast<uint32_t>(facets.quads.size());
    const auto columns = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    const uint32_t rows = (count + columns - 1) / columns;
    atlas.width_px = columns * block_px;
    atlas.height_px = rows * block_px;
    atlas.rgb.assign(std::size_t{atlas.width_px} * atlas.height_px, {0, 0, 0});
    for (uint32_t q = 0; q < count; ++q) {
        const uint32_t left = (q % columns) * block_px, top = (q / columns) * block_px;
        std::array<const Facets::Vertex*, 4> v{};
        for (unsigned k = 0; k < 4; ++k) v[k] = &facets.vertices[facets.quads[q][k]];
        for (uint32_t y = 0; y < block_px; ++y) {
            for (uint32_t x = 0; x < block_px; ++x) {
                const double s = static_cast<double>(x) / (block_px - 1);
                const double t = static_cast<double>(y) / (block_px - 1);
                const auto mix = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
                    return Vec3((1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * d + s * c));
                };
                atlas.rgb[std::size_t{top + y} * atlas.width_px + left + x] = painter.colourAt(
                    mix(v[0]->p_obj, v[1]->p_obj, v[2]->p_obj, v[3]->p_obj),
                    mix(v[0]->normal, v[1]->normal, v[2]->normal, v[3]->normal).normalized());
            }
        }
        const auto corner = [&](uint32_t x, uint32_t y) {
            const auto last = static_cast<float>(block_px - 1);
            return std::array<float, 2>{
                (static_cast<float>(left) + 0.5F + last * static_cast<float>(x)) /
                    static_cast<float>(atlas.width_px),
                (static_cast<float>(top) + 0.5F + last * static_cast<float>(y)) /
                    static_cast<float>(atlas.height_px)};
        };
        atlas.corners.push_back({corner(0, 0), corner(1, 0), corner(0, 1)});
        atlas.corners.push_back({corner(1, 1), corner(0, 1), corner(1, 0)});
    }
    return atlas;
}

}  // namespace

ColouredMesh makeMesh(const ObjectModel& model, const MeshOptions& options) {
    ColouredMesh mesh;
    if (model.size() == 0) return mesh;
    const DistanceGrid grid(model, options);
    Facets facets = surfaceNets(grid);
    facets.keepOnly(nearPoints(model, facets, options.trim_radii, grid.voxel_m()));
    facets.dropSmallPieces(options.min_piece_triangles / 2);
    const Painter painter(model, grid.voxel_m());
    for (const auto& v : facets.vertices) {
        mesh.vertices.push_back(
            {floats(v.p_obj), floats(v.normal), painter.colourAt(v.p_obj, v.normal)});
    }
    for (const auto& q : facets.quads) {
        mesh.triangles.push_back({q[0], q[1], q[3]});
        mesh.triangles.push_back({q[2], q[3], q[1]});
    }
    if (options.block_px > 1 && !facets.quads.empty()) {
        mesh.atlas = makeAtlas(facets, painter, options.block_px);
    }
    return mesh;
}

}  // namespace djpete::texture
