#include "street_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "building.h"
#include "foliage.h"
#include "ground.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

using geometry::SE3;
using geometry::Vec2;

constexpr std::size_t kTrees = 6, kHedges = 3;

/// A rectangle on the ground that something stands on.
struct Footprint {
    Vec2 centre, x, half;  // axis x and half sizes along it and across
    Vec2 corner(int i) const {
        const Vec2 y(-x.y(), x.x());
        return centre + (i % 2 == 0 ? -1.0 : 1.0) * half.x() * x +
               (i < 2 ? -1.0 : 1.0) * half.y() * y;
    }
    bool overlaps(const Footprint& o) const {
        for (const auto* f : {this, &o}) {
            const Vec2 axes[2] = {f->x, Vec2(-f->x.y(), f->x.x())};
            for (const Vec2& axis : axes) {
                double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
                const Footprint* both[2] = {this, &o};
                for (std::size_t k = 0; k < 2; ++k) {
                    for (int i = 0; i < 4; ++i) {
                        const double d = axis.dot(both[k]->corner(i));
                        low[k] = std::min(low[k], d);
                        high[k] = std::max(high[k], d);
                    }
                }
                if (high[0] < low[1] || high[1] < low[0]) return false;
            }
        }
        return true;
    }
};

/// Builds along one street after the other; what stands already is never built over.
class StreetBuilder {
  public:
    StreetBuilder(StreetModel& model, const Network& network, uint32_t seed)
        : model_(model), mesh_(model.mesh), network_(network), seed_(seed) {}

    void buildRoad(uint32_t r) {
        road_ = &network_.roads()[r];
        for (uint32_t sideIndex = 0; sideIndex < 2; ++sideIndex) {
            const double side = sideIndex == 0 ? -1.0 : 1.0;
            uint32_t n = 0;
            for (double s = 2; s < road_->length_m() - 10;) {
                const uint32_t id = hash(seed_, 100U + sideIndex + 2 * r, n++);
                const double width = static_cast<double>(between(hash(id, 10U), 8.F, 15.F));
                s += addPlot(s, width, side, id);
            }
        }
    }

    /// Trees, lamps and signs on the pavements.
    void furnishRoad(uint32_t r) {
        road_ = &network_.roads()[r];
        for (uint32_t sideIndex = 0; sideIndex < 2; ++sideIndex) {
            const double side = sideIndex == 0 ? -1.0 : 1.0;
            uint32_t n = 0;
            for (double s = 4; s < road_->length_m() - 4;) {
                const uint32_t id = hash(seed_, 5000U + sideIndex + 2 * r, n++);
                const double lateral = side * (kRoadHalfWidth_m + 0.45);
                if (onPavement(at(s, lateral), 0.4)) {
                    if (unit(hash(id, 11U)) < 0.6F)
                        addTree(s, lateral, id);
                    else
                        addPole(s, side, id);
                }
                s += static_cast<double>(between(hash(id, 12U), 7.F, 15.F));
            }
        }
    }

    /// Trees behind the houses, where there is room.
    void plantYards() {
        constexpr double kGrid_m = 11;
        std::set<std::pair<int, int>> cells;
        const int reach = static_cast<int>(Network::kReach_m / kGrid_m);
        for (const auto& road : network_.roads()) {
            for (double s = 0; s <= road.length_m(); s += kGrid_m) {
                const Vec2 p = road.poseAt(s).translation().head<2>() / kGrid_m;
                for (int y = -reach; y <= reach; ++y)
                    for (int x = -reach; x <= reach; ++x)
                        cells.insert({static_cast<int>(std::floor(p.x())) + x,
                                      static_cast<int>(std::floor(p.y())) + y});
            }
        }
        for (const auto& [x, y] : cells) {
            const uint32_t h =
                hash(seed_, 700U, static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            if (unit(h) > 0.45F) continue;
            const Vec2 jitter(static_cast<double>(unit(hash(h, 1U))),
                              static_cast<double>(unit(hash(h, 2U))));
            const Vec2 p = kGrid_m * (Vec2(x, y) + jitter);
            if (network_.edge_m(p) < kRoadHalfWidth_m + kPavement_m + 8) continue;
            if (!isFree({p, Vec2::UnitX(), Vec2(1.2, 1.2)})) continue;
            Vec3f foot = onGround(p);
            foot.z() -= 0.1F;
            model_.plants.push_back({hash(h, 3U) % kTrees, foot, between(hash(h, 4U), 0.F, 6.28F),
                                     between(hash(h, 5U), 1.0F, 1.9F)});
        }
    }

  private:
    Vec2 at(double s, double lateral) const {
        return road_->poseAt(s, lateral).translation().head<2>();
    }
    Vec3f onGround(const Vec2& p) const {
        return Vec3f(static_cast<float>(p.x()), static_cast<float>(p.y()),
                     static_cast<float>(network_.ground_m(p)));
    }
    Vec3f foot(double s, double lateral) const { return onGround(at(s, lateral)); }
    Vec3f along(double s) const { return road_->poseAt(s).rotation().col(0).cast<float>(); }
    Vec3f inward(double s, double side) const {
        return static_cast<float>(-side) * road_->poseAt(s).rotation().col(1).cast<float>();
    }
    /// True at least `inside_m` from the kerb, and out of the own vehicle's way.
    bool onPavement(const Vec2& p, double inside_m) const {
        return network_.edge_m(p) > kRoadHalfWidth_m + inside_m &&
               network_.routeDistance_m(p) > 1.8;
    }
    /// True if nothing else stands on a rectangle and all of it is beyond the pavements.
    bool isFree(const Footprint& f) const {
        const Vec2 y(-f.x.y(), f.x.x());
        for (double v = -1; v <= 1.01; v += 0.5) {
            for (double u = -1; u <= 1.01; u += 0.25) {
                const Vec2 p = f.centre + u * f.half.x() * f.x + v * f.half.y() * y;
                if (network_.edge_m(p) < kRoadHalfWidth_m + kPavement_m - 0.1) return false;
            }
        }
        return std::none_of(built_.begin(), built_.end(), [&](const Footprint& b) {
            return (b.centre - f.centre).norm() < 40 && b.overlaps(f);
        });
    }
    Footprint footprint(double mid, double width, double depth, double side, double setback) const {
        const double out = side * (kRoadHalfWidth_m + kPavement_m + setback + 0.5 * depth);
        const SE3 T = road_->poseAt(mid, out);
        return {T.translation().head<2>(), T.rotation().col(0).head<2>(),
                Vec2(0.5 * width, 0.5 * depth)};
    }

    void addHedgeRow(double from, double to, double lateral, uint32_t id) {
        const auto count = static_cast<int>((to - from) / 2.0);
        for (int i = 0; i < count; ++i) {
            const double s = from + 2.0 * i + 1.0;
            const Vec2 p = at(s, lateral);
            if (!onPavement(p, kPavement_m + 0.3)) continue;
            const auto k = static_cast<std::size_t>(hash(id, static_cast<uint32_t>(i)) % kHedges);
            model_.plants.push_back({kTrees + k, onGround(p),
                                     static_cast<float>(road_->poseAt(s).yaw_rad()),
                                     between(id, 0.85F, 1.1F)});
        }
    }

    void addTree(double s, double lateral, uint32_t id) {
        Vec3f p = foot(s, lateral);
        p.z() -= 0.1F;
        model_.plants.push_back({hash(id, 1U) % kTrees, p, between(hash(id, 2U), 0.F, 6.28F),
                                 between(hash(id, 3U), 0.85F, 1.3F)});
    }

    /// Trees and a hedge where no house stands. Returns the length used.
    double addGarden(double s, double width, double side, uint32_t id) {
        const double fence = kRoadHalfWidth_m + kPavement_m + 0.45;
        addHedgeRow(s, s + width, side * fence, id);
        for (uint32_t k = 0; k < 3; ++k) {
            const double lateral = side * (fence + 3.0 + 2.0 * k),
                         at_m = s + width * (0.2 + 0.3 * k);
            const Vec2 p = at(at_m, lateral);
            const Footprint spot{p, Vec2::UnitX(), Vec2(1.2, 1.2)};
            if (isFree(spot)) addTree(at_m, lateral, hash(id, k));
        }
        return width;
    }

    /// A house whose front runs along the street, or a garden. Returns the length used.
    double addPlot(double s, double width, double side, uint32_t id) {
        if (unit(hash(id, 1U)) < 0.16F) return addGarden(s, width, side, id);
        const double setback = unit(hash(id, 13U)) < 0.45F
                                   ? 0.1
                                   : static_cast<double>(between(hash(id, 2U), 2.2F, 4.5F));
        const double gap = unit(hash(id, 5U)) < 0.55F
                               ? 0.05
                               : static_cast<double>(between(hash(id, 6U), 1.F, 4.F));
        double depth = static_cast<double>(between(hash(id, 3U), 8.F, 11.F));
        const double mid = s + 0.5 * width;
        Footprint base = footprint(mid, width - gap, depth, side, setback);
        if (!isFree(base)) {
            depth = 6;
            base = footprint(mid, width - gap, depth, side, setback);
            if (!isFree(base)) return 0.5 * addGarden(s, 0.5 * width, side, id) + 0.25 * width;
        }
        built_.push_back(base);
        Plot plot;
        plot.width_m = static_cast<float>(width - gap);
        plot.depth_m = static_cast<float>(depth);
        plot.y = inward(mid, side);
        plot.x = plot.y.cross(Vec3f::UnitZ());
        plot.origin = foot(mid, side * (kRoadHalfWidth_m + kPavement_m + setback)) -
                      0.5F * plot.width_m * plot.x;
        addHouse(mesh_, plot, id);
        addFoundation(plot, id);
        if (setback > 2) addFence(s, mid, width, side, id, plot.width_m);
        return width;
    }

    /// Down into sloping ground.
    void addFoundation(const Plot& plot, uint32_t id) {
        if (network_.terrain().lowest_m() == 0) return;
        constexpr float kDown_m = 2.F;
        const uint32_t stone = mesh_.addFinish(Material::Stone, Vec3f(0.30F, 0.28F, 0.26F), id);
        mesh_.addBox(plot.at(0.5F * plot.width_m, -0.5F * plot.depth_m, -kDown_m),
                     {plot.width_m, plot.depth_m, kDown_m}, plot.x, stone);
    }

    void addFence(double s, double mid, double width, double side, uint32_t id, float houseWidth) {
        const double fence = kRoadHalfWidth_m + kPavement_m + 0.45;
        const float kind = unit(hash(id, 14U));
        if (kind < 0.3F) {
            const uint32_t wall = mesh_.addFinish(Material::Stone, Vec3f(0.40F, 0.37F, 0.32F), id);
            mesh_.addBox(foot(mid, side * fence), {houseWidth, 0.25F, between(id, 0.6F, 1.1F)},
                         along(mid), wall);
        } else if (kind < 0.5F) {
            addPickets(s, s + width - 2.0, side * fence, id);
        } else if (kind < 0.8F) {
            addHedgeRow(s, s + width - 2.0, side * fence, id);
        }
        if (kind > 0.3F) addTree(mid + 0.3 * width, side * (fence + 1.3), hash(id, 15U));
    }

    /// A fence of upright boards between posts.
    void addPickets(double from, double to, double lateral, uint32_t id) {
        constexpr double kBoard_m = 0.16;
        static const std::array<Vec3f, 3> kPaint{
            Vec3f(0.24F, 0.16F, 0.10F), Vec3f(0.45F, 0.44F, 0.41F), Vec3f(0.10F, 0.14F, 0.11F)};
        const uint32_t wood =
            mesh_.addFinish(Material::Wood, kPaint[hash(id, 31U) % kPaint.size()], id);
        const float tall = between(hash(id, 32U), 0.8F, 1.15F);
        for (double s = from; s + kBoard_m < to; s += kBoard_m) {
            const Vec3f p = foot(s, lateral);
            mesh_.addBox(p + Vec3f(0, 0, 0.06F), {0.105F, 0.022F, tall - 0.06F}, along(s), wood);
        }
        for (double s = from; s + 2.0 < to; s += 2.0) {
            for (float z : {0.25F, tall - 0.25F}) {
                const Vec3f a = foot(s, lateral) + Vec3f(0, 0, z),
                            b = foot(s + 2.0, lateral) + Vec3f(0, 0, z);
                mesh_.addBox(0.5F * (a + b), {(b - a).norm(), 0.06F, 0.07F}, (b - a).normalized(),
                             wood);
            }
        }
    }

    void addPole(double s, double side, uint32_t id) {
        const Vec3f base = foot(s, side * (kRoadHalfWidth_m + 0.45)), in = inward(s, side);
        const uint32_t metal = mesh_.addFinish(Material::Metal, Vec3f(0.30F, 0.31F, 0.31F), id);
        if (unit(hash(id, 9U)) < 0.5F) {  // lamp
            const Vec3f top = base + Vec3f(0, 0, 6.5F);
            mesh_.addRod(base, top, 0.075F, 0.05F, 10, false, metal);
            mesh_.addRod(top, top + 1.3F * in + Vec3f(0, 0, 0.25F), 0.04F, 0.035F, 8, false, metal);
            mesh_.addBox(top + 1.4F * in + Vec3f(0, 0, 0.18F), {0.7F, 0.25F, 0.12F}, in, metal);
            return;
        }
        static const std::array<Vec3f, 4> kSigns{
            Vec3f(0.03F, 0.10F, 0.45F), Vec3f(0.55F, 0.04F, 0.04F), Vec3f(0.70F, 0.68F, 0.62F),
            Vec3f(0.65F, 0.45F, 0.03F)};
        mesh_.addRod(base, base + Vec3f(0, 0, 2.9F), 0.035F, 0.035F, 8, false, metal);
        const uint32_t face = mesh_.addFinish(Material::Sign, kSigns[hash(id, 3U) % 4], id);
        const float tall = unit(hash(id, 4U)) < 0.5F ? 0.6F : 0.85F;
        const Vec3f u = 0.3F * in, low = base + Vec3f(0, 0, 2.85F - tall) - 0.045F * along(s);
        mesh_.addQuad(low - u, low + u, low + u + Vec3f(0, 0, tall), low - u + Vec3f(0, 0, tall),
                      face, mesh_.newPatch());
    }

    StreetModel& model_;
    Mesh& mesh_;
    const Network& network_;
    uint32_t seed_;
    const Street* road_ = nullptr;
    std::vector<Footprint> built_;
};

}  // namespace

StreetModel buildStreet(const Network& network, uint32_t seed) {
    StreetModel model;
    for (auto detail : {LeafDetail::Fine, LeafDetail::Coarse}) {
        auto& made = detail == LeafDetail::Fine ? model.prototypes : model.coarse;
        for (uint32_t k = 0; k < kTrees; ++k) made.push_back(makeTree(hash(seed, 500U, k), detail));
        for (uint32_t k = 0; k < kHedges; ++k)
            made.push_back(makeHedge(hash(seed, 510U, k), detail));
    }
    addGround(model.mesh, network, seed);
    StreetBuilder builder(model, network, seed);
    const auto roads = static_cast<uint32_t>(network.roads().size());
    for (uint32_t r = 0; r < roads; ++r) builder.buildRoad(r);
    for (uint32_t r = 0; r < roads; ++r) builder.furnishRoad(r);
    builder.plantYards();
    model.mesh.normals.resize(model.mesh.vertices.size(), Vec3f::Zero());
    return model;
}

}  // namespace djpete::simulator
