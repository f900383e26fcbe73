#include "djpete/texture/surface.h"

#include <algorithm>
#include <cmath>

#include "closing.h"
#include "coherent_points.h"
#include "distance_grid.h"
#include "point_grid.h"
#include "surface_nets.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr float kGrey = 255 * ObjectModel::kNeutralGrey;
constexpr int kSpreadSweeps = 40;

using Rgb = std::array<float, 3>;  ///< 0..255

std::array<uint8_t, 3> bytes(const Rgb& rgb) {
    std::array<uint8_t, 3> out{};
    for (unsigned c = 0; c < 3; ++c) {
        out[c] = static_cast<uint8_t>(std::lround(std::clamp(rgb[c], 0.0F, 255.0F)));
    }
    return out;
}

/// Per vertex the nearest point that faces the same way and is within so many of its radii.
std::vector<uint32_t> nearestPoints(const ObjectModel& model, const Facets& facets, double radii,
                                    double voxel_m) {
    double largest = voxel_m;
    for (const float r : model.radius_m) largest = std::max(largest, static_cast<double>(r));
    largest = std::min(largest, 0.4);
    const PointGrid grid(model, 0.1);
    std::vector<uint32_t> out;
    for (const auto& v : facets.vertices) {
        uint32_t nearest = Facets::kNoPoint;
        double nearest2 = 0;
        grid.forWithin(v.p_obj, radii * largest, [&](uint32_t i, double d2) {
            const double reach =
                radii * std::max(static_cast<double>(model.radius_m[i]), 0.8 * voxel_m);
            if (d2 > reach * reach || !(v.normal.dot(vec3(model.normals[i])) > 0)) return;
            if (nearest != Facets::kNoPoint && (d2 > nearest2 || (d2 == nearest2 && i > nearest)))
                return;
            nearest = i;
            nearest2 = d2;
        });
        out.push_back(nearest);
    }
    return out;
}

/// Cuts off what no point supports (unless closed), and loose pieces.
void trim(const ObjectModel& model, const MeshOptions& options, double voxel_m, Facets& facets) {
    auto pointOf = nearestPoints(model, facets, options.trim_radii, voxel_m);
    if (!options.close) {
        std::vector<bool> keep;
        for (const uint32_t point : pointOf) keep.push_back(point != Facets::kNoPoint);
        facets.keepOnly(keep);
        pointOf.erase(std::remove(pointOf.begin(), pointOf.end(), Facets::kNoPoint), pointOf.end());
    }
    facets.dropSmallPieces(options.min_piece_triangles / 2, options.min_piece_points, pointOf);
}

class Painter {
  public:
    Painter(const ObjectModel& model, double voxel_m)
        : model_(model),
          coloured_(model, 0.1, [&](uint32_t i) { return model.colours[i].count > 0; }),
          voxel_m_(voxel_m) {}

    /// Of the nearest points that face the same way, if there are any.
    std::optional<Rgb> colourAt(const Vec3& p, const Vec3& n) const {
        for (const double reach : {2 * voxel_m_, 4 * voxel_m_}) {
            if (const auto rgb = meanWithin(p, n, reach)) return rgb;
        }
        return std::nullopt;
    }

  private:
    std::optional<Rgb> meanWithin(const Vec3& p, const Vec3& n, double reach_m) const {
        Rgb sum{0, 0, 0};
        float total = 0;
        const double spread = reach_m / 4;
        coloured_.forWithin(p, reach_m, [&](uint32_t i, double d2) {
            const double facing = n.dot(vec3(model_.normals[i]));
            if (facing < 0.2) return;
            const auto weight = static_cast<float>(facing * std::exp(-d2 / (2 * spread * spread)));
            for (unsigned c = 0; c < 3; ++c) sum[c] += weight * model_.colours[i].mean[c];
            total += weight;
        });
        if (!(total > 0)) return std::nullopt;
        return Rgb{sum[0] / total, sum[1] / total, sum[2] / total};
    }

    const ObjectModel& model_;
    PointGrid coloured_;
    double voxel_m_;
};

/// Vertices far from coloured points take the colours of those around them on the surface.
std::vector<Rgb> vertexColours(const Facets& facets, const Painter& painter) {
    std::vector<std::optional<Rgb>> known;
    for (const auto& v : facets.vertices) known.push_back(painter.colourAt(v.p_obj, v.normal));
    std::vector<std::optional<Rgb>> colours = known;
    std::vector<Rgb> sums(colours.size());
    std::vector<float> counts(colours.size());
    // Ring by ring until every vertex that can be reached has one; then some more to smooth.
    bool grew = true;
    for (int more = kSpreadSweeps; grew || more > 0; more -= grew ? 0 : 1) {
        std::fill(sums.begin(), sums.end(), Rgb{0, 0, 0});
        std::fill(counts.begin(), counts.end(), 0.0F);
        for (const auto& quad : facets.quads) {
            for (unsigned k = 0; k < 4; ++k) {
                const auto give = [&](uint32_t from, uint32_t to) {
                    if (!colours[from] || known[to]) return;
                    for (unsigned c = 0; c < 3; ++c) sums[to][c] += (*colours[from])[c];
                    counts[to] += 1;
                };
                give(quad[k], quad[(k + 1) % 4]);
                give(quad[(k + 1) % 4], quad[k]);
            }
        }
        grew = false;
        for (std::size_t v = 0; v < colours.size(); ++v) {
            if (known[v] || !(counts[v] > 0)) continue;
            grew |= !colours[v].has_value();
            colours[v] =
                Rgb{sums[v][0] / counts[v], sums[v][1] / counts[v], sums[v][2] / counts[v]};
        }
    }
    std::vector<Rgb> out;
    for (const auto& rgb : colours) out.push_back(rgb.value_or(Rgb{kGrey, kGrey, kGrey}));
    return out;
}

/// A block per quad: its corners are the middles of the block's corner texels.
MeshAtlas makeAtlas(const Facets& facets, const Painter& painter, const std::vector<Rgb>& colours,
                    uint32_t block_px) {
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
                const std::array<double, 4> share{(1 - s) * (1 - t), s * (1 - t), s * t,
                                                  (1 - s) * t};
                Vec3 p = Vec3::Zero(), n = Vec3::Zero();
                Rgb around{0, 0, 0};
                for (unsigned k = 0; k < 4; ++k) {
                    p += share[k] * v[k]->p_obj;
                    n += share[k] * v[k]->normal;
                    const Rgb& rgb = colours[facets.quads[q][k]];
                    for (unsigned c = 0; c < 3; ++c) {
                        around[c] += static_cast<float>(share[k]) * rgb[c];
                    }
                }
                const auto own = painter.colourAt(p, n.normalized());
                atlas.rgb[std::size_t{top + y} * atlas.width_px + left + x] =
                    bytes(own.value_or(around));
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

ColouredMesh makeMesh(const ObjectModel& all, const MeshOptions& options) {
    ColouredMesh mesh;
    const ObjectModel model =
        all.subset(coherentPoints(all, options.min_piece_points, options.voxel_m));
    if (model.size() == 0) return mesh;
    DistanceGrid grid(model, options);
    if (options.close) closeGaps(grid, model);
    Facets facets = surfaceNets(grid);
    trim(model, options, grid.voxel_m(), facets);
    const Painter painter(model, grid.voxel_m());
    const std::vector<Rgb> colours = vertexColours(facets, painter);
    for (std::size_t i = 0; i < facets.vertices.size(); ++i) {
        const auto& v = facets.vertices[i];
        mesh.vertices.push_back({floats(v.p_obj), floats(v.normal), bytes(colours[i])});
    }
    for (const auto& q : facets.quads) {
        mesh.triangles.push_back({q[0], q[1], q[3]});
        mesh.triangles.push_back({q[2], q[3], q[1]});
    }
    if (options.block_px > 1 && !facets.quads.empty()) {
        mesh.atlas = makeAtlas(facets, painter, colours, options.block_px);
    }
    return mesh;
}

}  // namespace djpete::texture
