#include <algorithm>
#include <cmath>
#include <sstream>

#include "djpete/texture/completion.h"
#include "edits.h"
#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;
using Rgb = std::array<float, 3>;

constexpr std::size_t kNeighbours = 8;
constexpr double kReach_m = 0.5;
constexpr double kColourReach_m = 0.15;
constexpr uint32_t kFewSamples = 2;
constexpr double kOddColour = 45;  ///< from the neighbours' median, at least

/// Mean distance to the nearest neighbours; kReach_m for each that is missing.
double loneliness(const ObjectModel& model, const PointGrid& grid, uint32_t i) {
    std::vector<double> d2s;
    grid.forWithin(vec3(model.point(i)), kReach_m, [&](uint32_t j, double d2) {
        if (j != i) d2s.push_back(d2);
    });
    const std::size_t count = std::min(kNeighbours, d2s.size());
    std::partial_sort(d2s.begin(), d2s.begin() + static_cast<std::ptrdiff_t>(count), d2s.end());
    double sum = kReach_m * static_cast<double>(kNeighbours - count);
    for (std::size_t k = 0; k < count; ++k) sum += std::sqrt(d2s[k]);
    return sum / kNeighbours;
}

Mask lonelyPoints(const ObjectModel& model, double sigmas) {
    const PointGrid grid(model, 0.1);
    std::vector<double> values;
    double sum = 0, sum2 = 0;
    for (uint32_t i = 0; i < model.size(); ++i) {
        values.push_back(loneliness(model, grid, i));
        sum += values.back();
        sum2 += values.back() * values.back();
    }
    const double n = std::max<double>(1, static_cast<double>(model.size()));
    const double deviation = std::sqrt(std::max(0.0, sum2 / n - sum / n * (sum / n)));
    Mask out;
    for (const double v : values) out.push_back(v > sum / n + sigmas * deviation + 1e-9);
    return out;
}

float medianOf(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The neighbours' median colour if the point's own is far from it; else nothing.
std::optional<Rgb> correction(const ObjectModel& model, const PointGrid& grid, uint32_t i) {
    std::vector<Rgb> near;
    const Vec3 n = vec3(model.normals[i]);
    grid.forWithin(vec3(model.point(i)), kColourReach_m, [&](uint32_t j, double) {
        if (j != i && n.dot(vec3(model.normals[j])) > 0.5) near.push_back(model.colours[j].mean);
    });
    if (near.size() < 5) return std::nullopt;
    Rgb median{};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (const Rgb& rgb : near) values.push_back(rgb[c]);
        median[c] = medianOf(values);
    }
    std::vector<float> apart;
    for (const Rgb& rgb : near) {
        apart.push_back(static_cast<float>((vec3(rgb) - vec3(median)).norm()));
    }
    const double limit = std::max(kOddColour, 3 * static_cast<double>(medianOf(apart)));
    if ((vec3(model.colours[i].mean) - vec3(median)).norm() <= limit) return std::nullopt;
    return median;
}

}  // namespace

void crop(ObjectModel& model, const Mask& in, bool keep, EditReport& report) {
    Mask kept;
    for (const bool inside : in) kept.push_back(inside == keep);
    const std::size_t before = model.size();
    model = model.subset(kept);
    report.removed += before - model.size();
}

void denoise(ObjectModel& model, const Mask& in, double sigmas, EditReport& report) {
    Mask lonely = lonelyPoints(model, sigmas);
    const PointGrid coloured(model, 0.1,
                             [&](uint32_t i) { return model.colours[i].count > 0 && !lonely[i]; });
    std::vector<std::pair<uint32_t, Rgb>> corrections;
    for (uint32_t i = 0; i < model.size(); ++i) {
        const uint32_t count = model.colours[i].count;
        if (!in[i] || count == 0 || count > kFewSamples) continue;
        if (const auto rgb = correction(model, coloured, i)) corrections.emplace_back(i, *rgb);
    }
    for (const auto& [i, rgb] : corrections) setColour(model, i, rgb);
    report.changed += corrections.size();
    for (std::size_t i = 0; i < lonely.size(); ++i) lonely[i] = lonely[i] && in[i];
    crop(model, lonely, false, report);
}

void symmetriseWithin(ObjectModel& model, const Mask& in, const Region& region,
                      EditReport& report) {
    ObjectModel whole = model;
    const SymmetryReport symmetry = symmetrise(whole);
    Mask keep(whole.size(), true);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (i >= model.size()) {
            keep[i] = region.contains(whole, i);
            report.added += keep[i] ? 1U : 0U;
        } else if (!in[i]) {
            whole.colours[i] = model.colours[i];
            whole.flags[i] = model.flags[i];
            whole.showColour(i);
        } else {
            report.changed += whole.flags[i] != model.flags[i] ? 1U : 0U;
        }
    }
    model = whole.subset(keep);
    std::ostringstream text;
    const SymmetryFit& fit = symmetry.fit;
    text << "symmetry plane ";
    text.precision(3);
    if (fit.refined) {
        text << "found by " << 100 * fit.overlap << " % of the points, " << fit.plane.offset_m
             << " m and " << fit.plane.yaw_rad * 180 / M_PI << " degrees from the box's";
    } else {
        text << "of the box, too little was seen of both sides to tell (" << 100 * fit.overlap
             << " % of the points)";
    }
    text << ", " << symmetry.contradicted << " points left out where sensors saw through";
    report.text = text.str();
}

void fillWithin(ObjectModel& model, const Mask& in, EditReport& report) {
    ObjectModel whole = model;
    fillColours(whole);
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!in[i] || whole.colours[i].count == model.colours[i].count) continue;
        model.colours[i] = whole.colours[i];
        model.flags[i] = whole.flags[i];
        model.showColour(i);
        ++report.changed;
    }
}

}  // namespace djpete::texture
