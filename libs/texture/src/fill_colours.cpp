#include <algorithm>
#include <cmath>

#include "djpete/texture/completion.h"
#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

struct Neighbour {
    uint32_t index = 0;
    float weight = 0;
};
using Neighbours = std::vector<Neighbour>;

constexpr std::size_t kMaxNeighbours = 12;

/// The points nearest to p on the side of the surface that faces to n, but `index` itself.
Neighbours neighboursOf(const ObjectModel& model, const PointGrid& grid, const Vec3& p,
                        const Vec3& n, uint32_t index, double reach_m) {
    std::vector<std::pair<double, uint32_t>> near;
    grid.forWithin(p, reach_m, [&](uint32_t i, double d2) {
        if (i != index && n.dot(vec3(model.normals[i])) > 0.2) near.emplace_back(d2, i);
    });
    std::sort(near.begin(), near.end());
    if (near.size() > kMaxNeighbours) near.resize(kMaxNeighbours);
    Neighbours out;
    const double spread = reach_m / 3;
    for (const auto& [d2, i] : near) {
        const double facing = n.dot(vec3(model.normals[i]));
        out.push_back(
            {i, static_cast<float>(facing * facing * std::exp(-d2 / (2 * spread * spread)))});
    }
    return out;
}

class Filling {
  public:
    Filling(const ObjectModel& model, const FillOptions& options)
        : model_(model), known_(model.size()), colour_(model.size()) {
        for (uint32_t i = 0; i < model.size(); ++i) {
            known_[i] = model.colours[i].count > 0;
            colour_[i] = model.colours[i].mean;
            if (!known_[i]) empty_.push_back(i);
        }
        const PointGrid all(model, options.reach_m);
        for (const uint32_t i : empty_) {
            const Vec3 p = vec3(model.point(i)), n = vec3(model.normals[i]);
            Neighbours near = neighboursOf(model, all, p, n, i, options.reach_m);
            if (options.mirror_reach_m > 0) {
                const SymmetryPlane box;
                const Neighbours other =
                    neighboursOf(model, all, box.mirrored(p), box.mirroredDirection(n), i,
                                 options.mirror_reach_m);
                near.insert(near.end(), other.begin(), other.end());
            }
            neighbours_.push_back(std::move(near));
        }
    }

    void run(const FillOptions& options) {
        spread();
        acrossGaps(options.max_distance_m);
        spread();
        for (unsigned s = 0; s < options.sweeps; ++s) {
            for (std::size_t k = 0; k < empty_.size(); ++k) {
                if (known_[empty_[k]]) takeMean(k);
            }
        }
    }

    std::size_t writeTo(ObjectModel& model) const {
        std::size_t filled = 0;
        for (const uint32_t i : empty_) {
            if (!known_[i]) continue;
            model.colours[i] = ColourSum();
            model.colours[i].add(colour_[i], 1.0F);
            model.flags[i] |= flag::kInferredColour;
            model.showColour(i);
            ++filled;
        }
        return filled;
    }

  private:
    /// Mean of the neighbours that have a colour; false if none has.
    bool takeMean(std::size_t k) {
        std::array<float, 3> sum{0, 0, 0};
        float weight = 0;
        for (const Neighbour& n : neighbours_[k]) {
            if (!known_[n.index]) continue;
            weight += n.weight;
            for (std::size_t c = 0; c < 3; ++c) sum[c] += n.weight * colour_[n.index][c];
        }
        if (!(weight > 1e-12F)) return false;
        for (std::size_t c = 0; c < 3; ++c) colour_[empty_[k]][c] = sum[c] / weight;
        return true;
    }

    /// Ring by ring from the known colours, as far as the surface is connected.
    void spread() {
        for (bool grew = true; grew;) {
            grew = false;
            std::vector<uint32_t> ring;
            for (std::size_t k = 0; k < empty_.size(); ++k) {
                if (!known_[empty_[k]] && takeMean(k)) ring.push_back(empty_[k]);
            }
            for (const uint32_t i : ring) known_[i] = true;
            grew = !ring.empty();
        }
    }

    /// What is not connected to a colour takes the nearest one, rather of the same side.
    void acrossGaps(double max_m) {
        const PointGrid coloured(model_, 0.3, [&](uint32_t i) { return known_[i]; });
        std::vector<uint32_t> found;
        for (const uint32_t i : empty_) {
            if (known_[i]) continue;
            double best = 2 * max_m;
            coloured.forWithin(vec3(model_.point(i)), max_m, [&](uint32_t j, double d2) {
                const double facing = vec3(model_.normals[i]).dot(vec3(model_.normals[j]));
                const double distance = std::sqrt(d2) * (facing > 0.2 ? 1 : 1.8);
                if (distance >= best) return;
                best = distance;
                colour_[i] = colour_[j];
            });
            if (best < 2 * max_m) found.push_back(i);
        }
        for (const uint32_t i : found) known_[i] = true;
    }

    const ObjectModel& model_;
    std::vector<bool> known_;
    std::vector<std::array<float, 3>> colour_;
    std::vector<uint32_t> empty_;
    std::vector<Neighbours> neighbours_;  ///< of empty_, in its order
};

}  // namespace

std::size_t fillColours(ObjectModel& model, const FillOptions& options) {
    if (model.size() == 0) return 0;
    model = model.clone();
    Filling filling(model, options);
    filling.run(options);
    return filling.writeTo(model);
}

}  // namespace djpete::texture
