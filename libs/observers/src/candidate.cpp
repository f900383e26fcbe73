#include "candidate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace djpete::observers {

namespace {

using geometry::Vec2;
using geometry::Vec3;
using Options = GeometricObserverOptions;

constexpr double kOutlineBin_rad = 0.0044;  // 0.25 degrees
constexpr float kOutlineLow_m = 0.3F;       // body of a car below its windows
constexpr float kOutlineHigh_m = 1.1F;
constexpr double kExtentQuantile = 0.01;  // stray returns do not stretch a box
constexpr float kOverhangFrom_m = 1.1F;   // no car is lower than this
constexpr float kOverhangGap_m = 0.35F;   // larger than between two scan lines on a roof's edge
constexpr double kGrazing = 0.12;         // sine; a side seen flatter than this returns nothing

/// 1 inside [low, high], falling off outside like a Gaussian of width sigma.
double within(double value, double low, double high, double sigma) {
    const double outside = value < low ? low - value : (value > high ? value - high : 0.0);
    return std::exp(-0.5 * outside * outside / (sigma * sigma));
}

double quantile(std::vector<double>& values, double share) {
    const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::vector<uint32_t> obstaclesOf(const Cluster& cluster, const GroundPlan& plan) {
    std::vector<uint32_t> out;
    for (uint32_t c : cluster) {
        for (uint32_t i = plan.cells()[c].first; i < plan.cells()[c].last; ++i) out.push_back(i);
    }
    return out;
}

/// Cheap bounds before anything is fitted.
bool couldBeCar(const Cluster& cluster, const GroundPlan& plan, const Options& o) {
    float x0 = 1e9F, x1 = -1e9F, y0 = 1e9F, y1 = -1e9F;
    uint32_t points = 0;
    for (uint32_t i : cluster) {
        const auto& c = plan.cells()[i];
        x0 = std::min(x0, c.x);
        x1 = std::max(x1, c.x);
        y0 = std::min(y0, c.y);
        y1 = std::max(y1, c.y);
        points += c.last - c.first;
    }
    const double diagonal = std::hypot(x1 - x0, y1 - y0);
    const double largest = std::hypot(o.lengthMax_m, o.widthMax_m) + 0.5;
    return static_cast<int>(points) >= o.minPoints && diagonal >= 0.8 && diagonal <= largest;
}

/// The nearest return of the body per azimuth bin.
std::vector<Vec2> outlineOf(const std::vector<uint32_t>& members, const GroundPlan& plan) {
    struct Hit {
        long bin;
        float range;
        Vec2 at;
    };
    const auto collect = [&](float low, float high) {
        std::vector<Hit> hits;
        for (uint32_t i : members) {
            const auto& p = plan.obstacles()[i];
            if (p.height < low || p.height > high) continue;
            const double azimuth = std::atan2(p.y, p.x);
            hits.push_back({std::lround(azimuth / kOutlineBin_rad), p.range, Vec2(p.x, p.y)});
        }
        std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
            return a.bin != b.bin ? a.bin < b.bin : a.range < b.range;
        });
        std::vector<Vec2> out;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            if (k == 0 || hits[k].bin != hits[k - 1].bin) out.push_back(hits[k].at);
        }
        return out;
    };
    auto out = collect(kOutlineLow_m, kOutlineHigh_m);
    if (out.size() < 8) out = collect(0.F, 3.F);
    return out;
}

/// Bounds of all members along the rectangle's axes, without the outermost returns.
void fitBounds(Rectangle& r, const std::vector<uint32_t>& members, const GroundPlan& plan) {
    for (int k = 0; k < 2; ++k) {
        const Vec2 e = r.axis(k);
        std::vector<double> along;
        for (uint32_t i : members) {
            const auto& p = plan.obstacles()[i];
            along.push_back(e.x() * static_cast<double>(p.x) + e.y() * static_cast<double>(p.y));
        }
        r.low[k] = quantile(along, kExtentQuantile);
        r.high[k] = quantile(along, 1 - kExtentQuantile);
    }
}

/// Coordinate along axis k of the side that faces the sensor, if one does.
std::optional<double> facingSide(const Rectangle& r, int k) {
    if (r.low[k] > 0) return r.low[k];
    if (r.high[k] < 0) return r.high[k];
    return std::nullopt;
}

/// True if something nearer hides what lies beyond `corner` in direction `outward`.
bool hiddenBeyond(const Vec2& corner, const Vec2& outward, const GroundPlan& plan) {
    const double cross = corner.x() * outward.y() - corner.y() * outward.x();
    const int turn = cross > 0 ? 1 : -1;
    const double azimuth = std::atan2(corner.y(), corner.x());
    int nearer = 0;
    for (int bin = 1; bin <= 4; ++bin) {
        if (plan.nearestRange(azimuth, turn * bin) < corner.norm() - 0.5) ++nearer;
    }
    return nearer >= 2;
}

/// Which ends of the rectangle along axis k are true ends of the object.
struct Ends {
    bool low = false, high = false;
    bool both() const { return low && high; }
};

Ends seenEnds(const Rectangle& r, int k, const GroundPlan& plan) {
    const auto sideK = facingSide(r, k);
    const auto sideM = facingSide(r, 1 - k);
    Ends ends;
    for (int which = 0; which < 2; ++which) {
        const double at = which == 0 ? r.low[k] : r.high[k];
        bool& seen = which == 0 ? ends.low : ends.high;
        if (sideK && *sideK == at) {
            seen = true;  // we look at this very side
            if (!sideM) continue;
        }
        if (!sideM) continue;
        Vec2 q;
        q[k] = at;
        q[1 - k] = *sideM;
        const Vec2 corner = r.fromAxes(q);
        const bool flat = std::abs(*sideM) < kGrazing * corner.norm();
        const bool nearCorner = seen;
        if (nearCorner) continue;
        seen = !flat && !hiddenBeyond(corner, which == 0 ? Vec2(-r.axis(k)) : r.axis(k), plan);
    }
    return ends;
}

/// Grows the rectangle along axis k to `size`: away from the sensor, or where it looks straight on,
/// at the end that was not seen, or at both.
void complete(Rectangle& r, int k, double size, const Ends& ends) {
    const double growth = size - (r.high[k] - r.low[k]);
    if (growth <= 0) return;
    const bool facesLow = r.low[k] > 0, facesHigh = r.high[k] < 0;
    if (facesLow || (ends.low && !ends.high && !facesHigh)) {
        r.high[k] += growth;
    } else if (facesHigh || ends.high != ends.low) {
        r.low[k] -= growth;
    } else {
        r.low[k] -= 0.5 * growth;
        r.high[k] += 0.5 * growth;
    }
}

/// Share of the visible side, in steps along it, that returned something at body height.
double fillOf(const Rectangle& r, int k, const std::vector<uint32_t>& members,
              const GroundPlan& plan) {
    const auto side = facingSide(r, 1 - k);
    const double extent = r.extent()[k];
    if (!side || extent < 0.4) return 0;
    const double range = r.centre().norm();
    const double step =
        std::clamp(0.008 * range * range / std::max(std::abs(*side), 0.5), 0.2, 0.8);
    const auto steps = static_cast<std::size_t>(std::ceil(extent / step));
    std::vector<int> hits(steps, 0);
    for (uint32_t i : members) {
        const auto& p = plan.obstacles()[i];
        if (p.height > kOutlineHigh_m) continue;
        const Vec2 q = r.toAxes(Vec2(p.x, p.y));
        if (std::abs(q[1 - k] - *side) > 0.5) continue;
        const auto s = static_cast<long>((q[k] - r.low[k]) / step);
        if (s >= 0 && s < static_cast<long>(steps)) ++hits[static_cast<std::size_t>(s)];
    }
    const auto full = std::count_if(hits.begin(), hits.end(), [](int h) { return h >= 2; });
    return static_cast<double>(full) / static_cast<double>(steps);
}

/// Drops what hangs above the object (branches, signs): everything over the first gap in height.
void dropOverhang(std::vector<uint32_t>& members, const GroundPlan& plan) {
    std::vector<float> heights;
    for (uint32_t i : members) heights.push_back(plan.obstacles()[i].height);
    std::sort(heights.begin(), heights.end());
    float top = std::numeric_limits<float>::infinity();
    for (std::size_t k = 1; k < heights.size(); ++k) {
        const float gap = heights[k] - heights[k - 1];
        if (heights[k - 1] < kOverhangFrom_m || gap < kOverhangGap_m) continue;
        top = heights[k - 1];
        break;
    }
    members.erase(std::remove_if(members.begin(), members.end(),
                                 [&](uint32_t i) { return plan.obstacles()[i].height > top; }),
                  members.end());
}

struct Profile {
    double height = 0;       ///< over the ground
    double upperExtent = 0;  ///< longest extent, along either axis, of the upper third
    double inBody = 0;       ///< share of returns below 1.1 m
};

Profile profileOf(const Rectangle& r, const std::vector<uint32_t>& members,
                  const GroundPlan& plan) {
    std::vector<double> heights;
    for (uint32_t i : members) heights.push_back(static_cast<double>(plan.obstacles()[i].height));
    Profile out;
    out.height = quantile(heights, 0.985);
    Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    int below = 0;
    for (uint32_t i : members) {
        const auto& p = plan.obstacles()[i];
        if (p.height < 1.1F) ++below;
        if (static_cast<double>(p.height) < 0.68 * out.height) continue;
        const Vec2 q = r.toAxes(Vec2(p.x, p.y));
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
    }
    out.upperExtent = (high - low).maxCoeff();
    out.inBody = below / static_cast<double>(members.size());
    return out;
}

/// Shares of the footprint, shrunk by 0.3 m, where ground was seen and where things rise higher
/// than any car.
struct Footprint {
    double ground = 0, tooHigh = 0;
};

Footprint footprintOf(const Rectangle& r, const GroundPlan& plan, const Options& o) {
    Footprint out;
    int cells = 0;
    for (double u = r.low.x() + 0.3; u <= r.high.x() - 0.3; u += o.cell_m) {
        for (double v = r.low.y() + 0.3; v <= r.high.y() - 0.3; v += o.cell_m) {
            const Vec2 p = r.fromAxes(Vec2(u, v));
            ++cells;
            if (plan.groundSeen(p.x(), p.y())) out.ground += 1;
            if (static_cast<double>(plan.highestAt(p.x(), p.y())) > o.heightMax_m) out.tooHigh += 1;
        }
    }
    if (cells > 0) {
        out.ground /= cells;
        out.tooHigh /= cells;
    }
    return out;
}

/// The rectangle with axis k taken as length, completed, and how well its sizes suit a car.
struct Hypothesis {
    Rectangle box;
    int lengthAxis = 0;
    Ends lengthEnds, widthEnds;
    double sizeScore = 0;
};

Hypothesis hypothesis(const Rectangle& seen, int k, const GroundPlan& plan, const Options& o) {
    Hypothesis h;
    h.box = seen;
    h.lengthAxis = k;
    h.lengthEnds = seenEnds(seen, k, plan);
    h.widthEnds = seenEnds(seen, 1 - k, plan);
    const double length = seen.extent()[k], width = seen.extent()[1 - k];
    // A long side that was seen whole vouches for the car; bumpers are round, so their far end is
    // often not seen although nothing hides it.
    const bool wholeLength = h.lengthEnds.both() && length >= o.lengthMin_m;
    const double widthLeast = wholeLength ? 0.65 * o.widthMin_m : o.widthMin_m;
    h.sizeScore = within(length, h.lengthEnds.both() ? o.lengthMin_m : 0.0, o.lengthMax_m, 0.3) *
                  within(width, h.widthEnds.both() ? widthLeast : 0.0, o.widthMax_m, 0.15);
    complete(h.box, k, wholeLength ? length : std::max(length, o.lengthPrior_m), h.lengthEnds);
    complete(h.box, 1 - k, std::max(width, o.widthPrior_m), h.widthEnds);
    // What was seen of each size speaks for the hypothesis.
    const double shown = std::max(length / h.box.extent()[k], width / h.box.extent()[1 - k]);
    h.sizeScore *= 0.4 + 0.6 * std::min(1.0, shown);
    return h;
}

void setSigmas(Candidate& c, const Hypothesis& h, double fitDistance_m, double visible_m) {
    const double range = c.box.centre().norm();
    const double noise = 0.05 + 0.002 * range + fitDistance_m;
    c.sigma_m = Vec3(h.lengthEnds.both() ? 0.15 : 0.35, h.widthEnds.both() ? 0.08 : 0.15, 0.08);
    c.sigma_m += Vec3::Constant(noise);
    const double yaw = 0.02 + 2.0 * noise / std::max(visible_m, 0.5);
    c.sigma_rad = Vec3(0.05, 0.05, std::min(yaw, 0.5));
}

}  // namespace

std::optional<Candidate> judge(const Cluster& cluster, const GroundPlan& plan, const Options& o) {
    if (!couldBeCar(cluster, plan, o)) return std::nullopt;
    Candidate c;
    c.obstacles = obstaclesOf(cluster, plan);
    dropOverhang(c.obstacles, plan);
    const auto outline = outlineOf(c.obstacles, plan);
    if (outline.size() < 5) return std::nullopt;
    Rectangle seen = fitRectangle(outline);
    fitBounds(seen, c.obstacles, plan);
    if (!(seen.extent().minCoeff() > 0) || seen.extent().maxCoeff() < 1.0) return std::nullopt;
    const double fit = meanDistanceToVisibleSides(seen, outline);

    const Hypothesis a = hypothesis(seen, 0, plan, o), b = hypothesis(seen, 1, plan, o);
    const Hypothesis& h = a.sizeScore >= b.sizeScore ? a : b;
    c.box = h.box;
    c.lengthAxis = h.lengthAxis;

    const Profile profile = profileOf(seen, c.obstacles, plan);
    const Footprint footprint = footprintOf(c.box, plan, o);
    const double longest = seen.extent().maxCoeff();
    const double fill =
        std::max(fillOf(seen, 0, c.obstacles, plan), fillOf(seen, 1, c.obstacles, plan));
    c.height_m = profile.height;
    c.score = h.sizeScore;
    c.score *= within(profile.height, o.heightMin_m, o.heightMax_m, 0.07);
    c.score *= within(profile.upperExtent, 0.42 * longest, 6.0, 0.25);
    c.score *= within(profile.inBody, 0.3, 1.0, 0.15);
    c.score *= within(fit, 0.0, 0.06 + 0.002 * c.box.centre().norm(), 0.05);
    c.score *= within(fill, 0.8, 1.0, 0.2);
    c.score *= within(footprint.ground, 0.0, 0.4, 0.12);
    c.score *= within(footprint.tooHigh, 0.0, 0.05, 0.15);
    c.score *= std::min(1.0, 0.5 + 0.5 * static_cast<double>(c.obstacles.size()) / 150.0);
    setSigmas(c, h, fit, longest);
    return c;
}

}  // namespace djpete::observers
