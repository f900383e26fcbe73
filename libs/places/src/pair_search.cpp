#include "pair_search.h"

#include <algorithm>

#include "djpete/geometry/point_residuals.h"
#include "hamming.h"

namespace djpete::places {

using geometry::SE3;
using geometry::Vec2;
using Corner = PlaceView::Corner;

namespace {

bool clear(const Nearest& n, const MatchOptions& options) {
    return n.best <= options.maxHamming &&
           static_cast<double>(n.best) <= options.maxRatio * static_cast<double>(n.second);
}

std::vector<obs::Descriptor> descriptorsOf(const PlaceView& view) {
    std::vector<obs::Descriptor> out;
    out.reserve(view.corners.size());
    for (const auto& c : view.corners) out.push_back(c.descriptor);
    return out;
}

/// Corners of a view in order of their columns, to find those near a pixel.
class ByColumn {
  public:
    explicit ByColumn(const PlaceView& view) : view_(view) {
        for (uint32_t i = 0; i < view.corners.size(); ++i) order_.push_back(i);
        std::sort(order_.begin(), order_.end(), [&](uint32_t i, uint32_t j) {
            const double ui = view.corners[i].px.x(), uj = view.corners[j].px.x();
            return ui != uj ? ui < uj : i < j;
        });
    }
    template <class Action>
    void near(const Vec2& px, double radius_px, const Action& action) const {
        auto it =
            std::lower_bound(order_.begin(), order_.end(), px.x() - radius_px,
                             [&](uint32_t i, double u) { return view_.corners[i].px.x() < u; });
        for (; it != order_.end(); ++it) {
            const Vec2 d = view_.corners[*it].px - px;
            if (d.x() > radius_px) break;
            if (d.squaredNorm() <= radius_px * radius_px) action(*it);
        }
    }

  private:
    const PlaceView& view_;
    std::vector<uint32_t> order_;
};

struct Found {
    uint32_t from, to;
    unsigned distance;
};

/// For each corner of `from` with a point: the clear nearest of `to` about its projection.
std::vector<Found> search(const PlaceView& from, const PlaceView& to, const SE3& T_to_from,
                          double radius_px, const MatchOptions& options) {
    const HammingFunction hamming = hammingFunction();
    const ByColumn there(to);
    std::vector<Found> out;
    for (uint32_t i = 0; i < from.corners.size(); ++i) {
        const Corner& corner = from.corners[i];
        if (!corner.p_cam) continue;
        const geometry::Vec3 p_to = T_to_from * *corner.p_cam;
        if (!(p_to.z() > geometry::kMinDepth_m)) continue;
        Nearest n;
        there.near(to.camera.project(p_to), radius_px, [&](uint32_t j) {
            const unsigned d = hamming(corner.descriptor, to.corners[j].descriptor);
            if (d < n.best) {
                n.second = n.best;
                n.best = d;
                n.index = j;
            } else if (d < n.second) {
                n.second = d;
            }
        });
        if (clear(n, options)) out.push_back({i, n.index, n.best});
    }
    return out;
}

}  // namespace

std::vector<CornerPair> pairsByLooks(const ViewPair& views) {
    const auto a = descriptorsOf(views.a), b = descriptorsOf(views.b);
    const auto fromA = nearest(a, b), fromB = nearest(b, a);
    std::vector<CornerPair> out;
    for (uint32_t i = 0; i < a.size(); ++i) {
        const Nearest& n = fromA[i];
        if (n.best == Nearest::kNone || !clear(n, views.options)) continue;
        if (fromB[n.index].index == i && clear(fromB[n.index], views.options)) {
            out.push_back({i, n.index});
        }
    }
    return out;
}

std::vector<CornerPair> pairsNear(const ViewPair& views, const SE3& T_a_b, double radius_px) {
    const auto aToB = search(views.a, views.b, T_a_b.inverse(), radius_px, views.options);
    const auto bToA = search(views.b, views.a, T_a_b, radius_px, views.options);
    struct Proposal {
        CornerPair pair;
        unsigned distance;
    };
    std::vector<Proposal> proposals;
    for (const auto& f : aToB) proposals.push_back({{f.from, f.to}, f.distance});
    for (const auto& f : bToA) proposals.push_back({{f.to, f.from}, f.distance});
    // The most alike first; each corner once.
    std::sort(proposals.begin(), proposals.end(), [](const Proposal& l, const Proposal& r) {
        if (l.distance != r.distance) return l.distance < r.distance;
        return l.pair.a != r.pair.a ? l.pair.a < r.pair.a : l.pair.b < r.pair.b;
    });
    std::vector<bool> usedA(views.a.corners.size(), false), usedB(views.b.corners.size(), false);
    std::vector<CornerPair> out;
    for (const auto& p : proposals) {
        if (usedA[p.pair.a] || usedB[p.pair.b]) continue;
        usedA[p.pair.a] = usedB[p.pair.b] = true;
        out.push_back(p.pair);
    }
    std::sort(out.begin(), out.end(),
              [](const CornerPair& l, const CornerPair& r) { return l.a < r.a; });
    return out;
}

}  // namespace djpete::places
