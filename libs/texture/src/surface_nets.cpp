#include "surface_nets.h"

#include <algorithm>
#include <numeric>

#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr uint32_t kNone = 0xFFFFFFFF;

class Nets {
  public:
    explicit Nets(const DistanceGrid& grid) : grid_(grid), size_(grid.corners()) {
        vertexOfCell_.assign(grid.index(0, 0, size_[2]), kNone);
        for (int z = 0; z + 1 < size_[2]; ++z) {
            for (int y = 0; y + 1 < size_[1]; ++y) {
                for (int x = 0; x + 1 < size_[0]; ++x) addVertex(x, y, z);
            }
        }
        for (int z = 1; z + 1 < size_[2]; ++z) {
            for (int y = 1; y + 1 < size_[1]; ++y) {
                for (int x = 1; x + 1 < size_[0]; ++x) {
                    for (int axis = 0; axis < 3; ++axis) addQuad({x, y, z}, axis);
                }
            }
        }
    }
    Facets out;

  private:
    const DistanceGrid::Corner& corner(int x, int y, int z) const {
        return grid_.at(grid_.index(x, y, z));
    }

    void addVertex(int x, int y, int z) {
        int inside = 0;
        for (int k = 0; k < 8; ++k) {
            const auto& c = corner(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
            if (!(c.weight > 0)) return;
            inside += c.distance < 0 ? 1 : 0;
        }
        if (inside == 0 || inside == 8) return;
        Vec3 sum = Vec3::Zero(), normal = Vec3::Zero();
        int crossings = 0;
        for (int k = 0; k < 8; ++k) {
            const Vec3 at(k & 1, k >> 1 & 1, k >> 2);
            const auto& a = corner(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
            normal += vec3(a.normal) / static_cast<double>(a.weight);
            for (int axis = 0; axis < 3; ++axis) {
                const int other = k | 1 << axis;
                if (other == k) continue;
                const auto& b = corner(x + (other & 1), y + (other >> 1 & 1), z + (other >> 2));
                if ((a.distance < 0) == (b.distance < 0)) continue;
                const auto from = static_cast<double>(a.distance);
                sum += at + from / (from - static_cast<double>(b.distance)) * Vec3::Unit(axis);
                ++crossings;
            }
        }
        const Vec3 mean = sum / crossings;
        vertexOfCell_[grid_.index(x, y, z)] = static_cast<uint32_t>(out.vertices.size());
        const double length = normal.norm();
        out.vertices.push_back({grid_.position(x + mean.x(), y + mean.y(), z + mean.z()),
                                length > 1e-9 ? Vec3(normal / length) : Vec3::UnitZ()});
    }

    /// Around the edge from corner `c` along `axis`, if the surface crosses it.
    void addQuad(const std::array<int, 3>& c, int axis) {
        const auto& a = corner(c[0], c[1], c[2]);
        const auto& b = corner(c[0] + (axis == 0), c[1] + (axis == 1), c[2] + (axis == 2));
        if (!(a.weight > 0 && b.weight > 0) || (a.distance < 0) == (b.distance < 0)) return;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<uint32_t, 4> quad{};
        for (unsigned k = 0; k < 4; ++k) {  // counter-clockwise seen from the edge's far end
            Eigen::Vector3i cell(c[0], c[1], c[2]);
            cell[u] -= k == 0 || k == 3 ? 1 : 0;
            cell[v] -= k < 2 ? 1 : 0;
            quad[k] = vertexOfCell_[grid_.index(cell.x(), cell.y(), cell.z())];
            if (quad[k] == kNone) return;
        }
        if (a.distance >= 0) std::swap(quad[1], quad[3]);  // outside is at the edge's start
        out.quads.push_back(quad);
    }

    const DistanceGrid& grid_;
    std::array<int, 3> size_;
    std::vector<uint32_t> vertexOfCell_;
};

}  // namespace

Facets surfaceNets(const DistanceGrid& grid) { return Nets(grid).out; }

void Facets::keepOnly(const std::vector<bool>& keep) {
    std::vector<uint32_t> renamed(vertices.size(), kNone);
    std::vector<Vertex> kept;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (!keep[i]) continue;
        renamed[i] = static_cast<uint32_t>(kept.size());
        kept.push_back(vertices[i]);
    }
    std::vector<std::array<uint32_t, 4>> keptQuads;
    for (auto quad : quads) {
        bool whole = true;
        for (auto& v : quad) {
            v = renamed[v];
            whole &= v != kNone;
        }
        if (whole) keptQuads.push_back(quad);
    }
    vertices = std::move(kept);
    quads = std::move(keptQuads);
}

void Facets::dropSmallPieces(std::size_t minQuads, std::size_t minPoints,
                             const std::vector<uint32_t>& pointOf) {
    std::vector<uint32_t> root(vertices.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&](uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const auto& quad : quads) {
        for (unsigned k = 1; k < 4; ++k) root[find(quad[k])] = find(quad[0]);
    }
    std::vector<std::size_t> quadsOf(vertices.size(), 0), pointsOf(vertices.size(), 0);
    for (const auto& quad : quads) ++quadsOf[find(quad[0])];
    std::vector<std::pair<uint32_t, uint32_t>> points;  // piece, point
    for (uint32_t v = 0; v < vertices.size(); ++v) {
        if (pointOf[v] != kNoPoint) points.emplace_back(find(v), pointOf[v]);
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::size_t most = 0;
    for (const auto& [piece, point] : points) most = std::max(most, ++pointsOf[piece]);
    const std::size_t enough = std::max<std::size_t>(1, std::min(minPoints, most / 4));
    std::vector<bool> keep(vertices.size()), used(vertices.size(), false);
    for (uint32_t v = 0; v < keep.size(); ++v) {
        const uint32_t piece = find(v);
        keep[v] = quadsOf[piece] >= std::max<std::size_t>(1, minQuads) && pointsOf[piece] >= enough;
    }
    for (const auto& quad : quads) {
        for (const uint32_t v : quad) used[v] = keep[v];
    }
    keepOnly(used);
}

}  // namespace djpete::texture
