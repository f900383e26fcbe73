#include "box_sides.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace djpete::backend {

namespace {

using geometry::Vec3;

constexpr double kInside_m = 0.15;  // of the box's side the panels may lie
constexpr double kMostSlack_m = 0.5;
constexpr double kBin_m = 0.02;
constexpr auto kBins = static_cast<std::size_t>((kInside_m + 2 * kMostSlack_m) / kBin_m) + 1;
constexpr double kStep_rad = 0.005;
constexpr double kFlat_m = 0.03;          // points so near a line may be of the panel
constexpr double kBulge_m = 0.02;         // panels bulge by about this
constexpr double kLeastSide_m = 1.0;      // shorter pieces say nothing of the heading
constexpr double kPanelTurn_rad = 0.003;  // sides are not quite parallel to the middle line
constexpr double kPiece_m = 0.25;         // a panel bulges alike over such a length
constexpr double kEndDepth_m = 0.3;       // bumpers are this round
constexpr double kEndShare = 0.1;         // of the end's points lie beyond its level

struct Xy {
    double x, y;
};

/// How many points lie in the best strip (two bins wide) along direction `slope`, and where.
struct Strip {
    std::size_t points = 0;
    double y_m = 0;
};

Strip bestStrip(const std::vector<Xy>& points, double slope, double low_m) {
    std::array<std::size_t, kBins> counts{};
    for (const auto& p : points) {
        const double bin = (p.y - slope * p.x - low_m) / kBin_m;
        if (bin >= 0 && bin < double(kBins)) ++counts[static_cast<std::size_t>(bin)];
    }
    Strip best;
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
        const std::size_t n = counts[b] + counts[b + 1];
        if (n >= best.points) best = {n, low_m + (double(b) + 1) * kBin_m};  // the outer of equals
    }
    return best;
}

}  // namespace

std::optional<SideLine> fitSide(const SidePoints& all, int sign, double width_m, double search_rad,
                                double slack_m) {
    const double slack = std::min(slack_m, kMostSlack_m);
    const double low = 0.5 * width_m - slack - kInside_m, high = 0.5 * width_m + slack;
    std::vector<Xy> points;
    for (const auto& p : all) {
        const double y = sign * p.y();
        if (y > low && y < high) points.push_back({p.x(), y});
    }
    const int steps = static_cast<int>(std::ceil(search_rad / kStep_rad));
    Strip best;
    double slope = 0;
    for (int s = 0; s <= 2 * steps; ++s) {  // from the middle outwards: the nearest of equals
        const double trial = (s % 2 == 0 ? 1 : -1) * ((s + 1) / 2) * kStep_rad;
        const Strip strip = bestStrip(points, trial, low);
        if (strip.points > best.points) {
            best = strip;
            slope = trial;
        }
    }
    if (best.points < 8) return std::nullopt;

    double y0 = best.y_m, spread = 0;
    for (int round = 0; round < 6; ++round) {
        double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
        for (const auto& p : points) {
            const double d = (p.y - y0 - slope * p.x) / kFlat_m;
            const double k = 1 / ((1 + d * d) * (1 + d * d));
            w += k;
            wx += k * p.x;
            wy += k * p.y;
            wxx += k * p.x * p.x;
            wxy += k * p.x * p.y;
        }
        const double mx = wx / w, my = wy / w;
        spread = wxx / w - mx * mx;
        if (spread < kLeastSide_m * kLeastSide_m / 12) return std::nullopt;
        slope = (wxy / w - mx * my) / spread;
        y0 = my - slope * mx;
    }
    SideLine out;
    out.y_m = sign * y0;
    out.turn_rad.value = sign * std::atan(slope);
    // Neighbouring points share the panel's bulges, so pieces count, not points.
    std::set<int> pieces;
    for (const auto& p : points) {
        if (std::abs(p.y - y0 - slope * p.x) < kFlat_m) {
            pieces.insert(static_cast<int>(std::floor(p.x / kPiece_m)));
        }
    }
    if (pieces.size() < 2) return std::nullopt;
    out.pieces = pieces.size();
    out.turn_rad.sigma =
        std::hypot(kPanelTurn_rad, kBulge_m / std::sqrt(double(pieces.size()) * spread));
    Outermost outermost;
    for (const auto& p : points) outermost.add(p.y - slope * p.x);
    out.outermost_m = sign * std::max(y0, outermost.value());
    return out;
}

std::optional<double> fitEnd(const SidePoints& points, int sign, const Vec3& size_m,
                             double slack_m) {
    const double limit = 0.5 * size_m.x() + slack_m;
    Outermost outermost;
    for (const auto& p : points) {
        const double x = sign * p.x();
        if (x < limit && std::abs(p.y()) < 0.5 * size_m.y()) outermost.add(x);
    }
    const double end = outermost.value();
    std::vector<double> near, ys;
    for (const auto& p : points) {
        const double x = sign * p.x();
        if (std::abs(p.y()) >= 0.5 * size_m.y() || x < end - kEndDepth_m || x >= limit) continue;
        near.push_back(x);
        ys.push_back(p.y());
    }
    if (near.size() < 10) return std::nullopt;
    std::sort(ys.begin(), ys.end());
    const std::size_t cut = ys.size() / 20;
    if (ys[ys.size() - 1 - cut] - ys[cut] < 0.5 * size_m.y()) return std::nullopt;
    const auto at = near.begin() + static_cast<long>(kEndShare * double(near.size()));
    std::nth_element(near.begin(), at, near.end(), std::greater<>());
    return sign * *at;
}

}  // namespace djpete::backend
