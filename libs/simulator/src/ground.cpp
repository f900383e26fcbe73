#include "ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "noise.h"

namespace djpete::simulator {
namespace {

using geometry::SE3;
using geometry::Vec2;

constexpr double kKerbTop_m = 0.14;
constexpr double kBlock_m = Terrain::kCell_m;  // heights are linear along the edges of its cells

/// Bands of the ground by distance from the centre lines.
enum Band : std::size_t { kRoad, kKerbTop, kSlabs, kLawn, kBands };
constexpr std::array<double, kBands - 1> kLimits{kRoadHalfWidth_m, kRoadHalfWidth_m + kKerbTop_m,
                                                 kRoadHalfWidth_m + kPavement_m};

struct Corner {
    Vec2 p;
    double edge_m;  // Network::edge_m there
};
using Polygon = std::vector<Corner>;

/// The part of a convex polygon with edge_m below (or above) a limit.
Polygon clipped(const Polygon& in, double limit, bool below) {
    Polygon out;
    for (std::size_t i = 0; i < in.size(); ++i) {
        const Corner &a = in[i], &b = in[(i + 1) % in.size()];
        const bool keepA = (a.edge_m < limit) == below, keepB = (b.edge_m < limit) == below;
        if (keepA) out.push_back(a);
        if (keepA != keepB) {
            const double f = (limit - a.edge_m) / (b.edge_m - a.edge_m);
            out.push_back({a.p + f * (b.p - a.p), limit});
        }
    }
    return out;
}

class GroundMaker {
  public:
    GroundMaker(Mesh& mesh, const Network& network, uint32_t seed)
        : mesh_(mesh), network_(network) {
        const auto roads = static_cast<uint32_t>(network.roads().size());
        for (uint32_t r = 0; r <= roads; ++r) {  // the last one stands for no road
            const uint32_t own = r == roads ? seed : hash(seed, 90U, r);
            auto& f = finish_.emplace_back();
            f[kRoad] = mesh.addFinish(Material::Asphalt, Vec3f(0.165F, 0.163F, 0.158F), own);
            f[kKerbTop] = mesh.addFinish(Material::Kerb, Vec3f(0.34F, 0.33F, 0.31F), own);
            f[kSlabs] = mesh.addFinish(Material::Pavement, Vec3f(0.33F, 0.31F, 0.28F), own);
            f[kLawn] = mesh.addFinish(Material::Grass, Vec3f(0.115F, 0.16F, 0.055F), own);
        }
        for (auto& p : patch_) p = mesh.newPatch();
        kerbPatch_ = mesh.newPatch();
    }

    void addAll() {
        std::set<std::pair<int, int>> blocks;
        const int reach = static_cast<int>(Network::kReach_m / kBlock_m) - 1;
        for (const auto& road : network_.roads()) {
            for (double s = 0; s <= road.length_m(); s += kBlock_m) {
                const Vec2 p = road.poseAt(s).translation().head<2>();
                const int x = static_cast<int>(std::floor(p.x() / kBlock_m)),
                          y = static_cast<int>(std::floor(p.y() / kBlock_m));
                for (int j = -reach; j <= reach; ++j)
                    for (int i = -reach; i <= reach; ++i)
                        if (i * i + j * j <= reach * reach) blocks.insert({x + i, y + j});
            }
        }
        Vec2 low(1e9, 1e9), high(-1e9, -1e9);
        for (const auto& [x, y] : blocks) {
            const Vec2 corner(x * kBlock_m, y * kBlock_m);
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
            addBlock(corner);
        }
        addHorizon(low, high);
    }

  private:
    /// Fine cells where kerbs and edges of pavements run, coarse ones elsewhere.
    void addBlock(const Vec2& corner) {
        const double middle = network_.edge_m(Vec2(corner + Vec2::Constant(0.5 * kBlock_m)));
        const double slack = 0.75 * kBlock_m;
        const bool fine = middle + slack > kLimits.front() && middle - slack < kLimits.back();
        const int n = fine ? 8 : 2;
        const double step = kBlock_m / n;
        std::vector<Corner> corners;
        for (int y = 0; y <= n; ++y)
            for (int x = 0; x <= n; ++x) corners.push_back(at(corner + step * Vec2(x, y)));
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const auto i = static_cast<std::size_t>(y * (n + 1) + x);
                const auto above = i + static_cast<std::size_t>(n) + 1;
                addTriangle({corners[i], corners[i + 1], corners[above + 1]});
                addTriangle({corners[i], corners[above + 1], corners[above]});
            }
        }
    }

    Corner at(const Vec2& p) const { return {p, network_.edge_m(p)}; }

    void addTriangle(const Polygon& triangle) {
        Vec2 middle = Vec2::Zero();
        for (const auto& c : triangle) middle += c.p / 3.0;
        const RoadPoint here = network_.nearest(middle);
        Polygon rest = triangle;
        for (std::size_t band = 0; band < kLimits.size() && rest.size() >= 3; ++band) {
            addPolygon(clipped(rest, kLimits[band], true), band, here);
            rest = clipped(rest, kLimits[band], false);
            if (band == kRoad) addKerb(rest, here);
        }
        addPolygon(rest, kLawn, here);
    }

    /// Metres along and across the nearest street. Where streets meet the middle line and such have
    /// no place: there v is far from them.
    Vec2f uv(const Vec2& p, const RoadPoint& here, std::size_t band) const {
        if (here.road == RoadPoint::kNone) return p.cast<float>();
        const SE3 T = network_.roads()[here.road].poseAt(here.s_m);
        const Vec2 d = p - T.translation().head<2>();
        const double along = here.s_m + T.rotation().col(0).head<2>().dot(d);
        const double across = T.rotation().col(1).head<2>().dot(d);
        const bool junction = band == kRoad && here.other_m < kRoadHalfWidth_m + 1.5;
        return Vec2(along, across + (junction ? 64.0 : 0.0)).cast<float>();
    }

    /// Each street has patterns of its own.
    uint32_t finishOf(std::size_t band, const RoadPoint& here) const {
        return (here.road == RoadPoint::kNone ? finish_.back() : finish_[here.road])[band];
    }

    Vec3f placed(const Vec2& p, double above) const {
        return Vec3f(static_cast<float>(p.x()), static_cast<float>(p.y()),
                     static_cast<float>(network_.terrain().height_m(p) + above));
    }

    void addPolygon(const Polygon& polygon, std::size_t band, const RoadPoint& here) {
        if (polygon.size() < 3) return;
        const double above = band == kRoad ? 0.0 : kKerb_m;
        const auto first = static_cast<uint32_t>(mesh_.vertices.size());
        for (const auto& c : polygon) mesh_.addVertex(placed(c.p, above), uv(c.p, here, band));
        for (uint32_t k = 1; k + 1 < polygon.size(); ++k)
            mesh_.addTriangle(first, first + k, first + k + 1, finishOf(band, here), patch_[band]);
    }

    /// The upright face along the edge of the road, where a polygon beyond it touches it.
    void addKerb(const Polygon& beyond, const RoadPoint& here) {
        std::vector<Vec2> edge;
        for (const auto& c : beyond)
            if (c.edge_m == kRoadHalfWidth_m) edge.push_back(c.p);
        if (edge.size() != 2) return;
        const Vec2 &a = edge.front(), &b = edge.back();
        if ((a - b).norm() < 1e-6) return;
        const Vec2f t0 = uv(a, here, kKerbTop), t1 = uv(b, here, kKerbTop);
        const auto k = static_cast<float>(kKerb_m);
        const uint32_t first = mesh_.addVertex(placed(a, 0), t0);
        mesh_.addVertex(placed(b, 0), t1);
        mesh_.addVertex(placed(b, kKerb_m), t1 + Vec2f(0, k));
        mesh_.addVertex(placed(a, kKerb_m), t0 + Vec2f(0, k));
        const uint32_t finish = finishOf(kKerbTop, here);
        mesh_.addTriangle(first, first + 1, first + 2, finish, kerbPatch_);
        mesh_.addTriangle(first, first + 2, first + 3, finish, kerbPatch_);
    }

    void addHorizon(const Vec2& low, const Vec2& high) {
        constexpr double kFar_m = 500;
        const bool flat = network_.terrain().lowest_m() == 0;
        const auto z = static_cast<float>(network_.terrain().lowest_m() - (flat ? 0.05 : 1.5));
        const Vec2f a = (low - Vec2::Constant(kFar_m)).cast<float>(),
                    b = (high + Vec2::Constant(kFar_m)).cast<float>();
        mesh_.addQuad({a.x(), a.y(), z}, {b.x(), a.y(), z}, {b.x(), b.y(), z}, {a.x(), b.y(), z},
                      finish_.back()[kLawn], mesh_.newPatch());
    }

    Mesh& mesh_;
    const Network& network_;
    std::vector<std::array<uint32_t, kBands>> finish_;  // by street
    std::array<uint32_t, kBands> patch_{};
    uint32_t kerbPatch_ = 0;
};

}  // namespace

void addGround(Mesh& mesh, const Network& network, uint32_t seed) {
    GroundMaker(mesh, network, seed).addAll();
}

}  // namespace djpete::simulator
