#include "edit_colours.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr float kLeastBrightness = 8, kMostLight = 3;  // of recolouring
constexpr float kColourSigma = 25;                     // grey levels; larger steps are edges
constexpr std::size_t kMostNeighbours = 40;
constexpr double kSamePlace_m = 0.2;

float luminance(const std::array<float, 3>& rgb) {
    return 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2];
}

void setColour(ObjectModel& model, std::size_t i, std::array<float, 3> rgb) {
    for (float& c : rgb) c = std::clamp(c, 0.0F, 255.0F);
    ColourSum sum;
    sum.add(rgb, 1);
    model.colours[i] = sum;
    model.seenIn[i] = 0;
    model.flags[i] |= flag::kEdited;
    model.showColour(i);
}

struct Neighbours {
    std::vector<std::size_t> index;
    std::vector<float> distance2;
};

Neighbours around(const ObjectModel& model, const std::array<float, 3>& p, std::size_t most) {
    Neighbours out;
    if (model.size() == 0) return out;
    model.cloud->kdTreeNClosestPoint3DIdx(p[0], p[1], p[2], std::min(most, model.size()), out.index,
                                          out.distance2);
    return out;
}

}  // namespace

void recolour(ObjectModel& model, const std::array<float, 3>& rgb, const Region& region) {
    std::vector<std::size_t> points;
    std::vector<float> brightness;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (model.colours[i].count == 0 || !region.contains(model, i)) continue;
        points.push_back(i);
        brightness.push_back(luminance(model.colours[i].mean));
    }
    if (points.empty()) return;
    auto sorted = brightness;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const float median = std::max(kLeastBrightness, *middle);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const float light = std::min(kMostLight, brightness[k] / median);
        setColour(model, points[k], {light * rgb[0], light * rgb[1], light * rgb[2]});
    }
}

void brush(ObjectModel& model, const std::array<float, 3>& rgb, const Region& region) {
    std::vector<std::size_t> points;  // first all: painting must not change who is in the region
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (region.contains(model, i)) points.push_back(i);
    }
    for (const std::size_t i : points) setColour(model, i, rgb);
}

void smoothColours(ObjectModel& model, double reach_m, const Region& region) {
    const auto reach2 = static_cast<float>(reach_m * reach_m);
    std::vector<std::pair<std::size_t, std::array<float, 3>>> smooth;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (model.colours[i].count == 0 || !region.contains(model, i)) continue;
        const auto& own = model.colours[i].mean;
        const auto near = around(model, model.point(i), kMostNeighbours);
        std::array<float, 3> sum{};
        float total = 0;
        for (std::size_t k = 0; k < near.index.size(); ++k) {
            const auto& other = model.colours[near.index[k]];
            if (near.distance2[k] > reach2 || other.count == 0) continue;
            float apart2 = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                apart2 += (other.mean[c] - own[c]) * (other.mean[c] - own[c]) / 3;
            }
            const float w = std::exp(-2 * near.distance2[k] / reach2 -
                                     apart2 / (2 * kColourSigma * kColourSigma));
            for (std::size_t c = 0; c < 3; ++c) sum[c] += w * other.mean[c];
            total += w;
        }
        smooth.push_back({i, {sum[0] / total, sum[1] / total, sum[2] / total}});
    }
    for (const auto& [i, rgb] : smooth) setColour(model, i, rgb);
}

void replaceColours(ObjectModel& model, const ObjectModel& other, const Region& region) {
    std::vector<bool> coloured(other.size());
    for (std::size_t i = 0; i < other.size(); ++i) coloured[i] = other.colours[i].count > 0;
    const ObjectModel from = other.subset(coloured);
    Vec3 scale(1, 1, 1);
    for (int i = 0; i < 3; ++i) {
        if (model.size_m[i] > 0.1 && other.size_m[i] > 0.1) {
            scale[i] = other.size_m[i] / model.size_m[i];
        }
    }
    std::vector<std::pair<std::size_t, std::array<float, 3>>> taken;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!region.contains(model, i)) continue;
        auto p = model.point(i);
        for (int k = 0; k < 3; ++k) {
            auto& c = p[static_cast<std::size_t>(k)];
            c *= static_cast<float>(scale[k]);
        }
        const auto near = around(from, p, 8);
        for (std::size_t k = 0; k < near.index.size(); ++k) {
            if (static_cast<double>(near.distance2[k]) > kSamePlace_m * kSamePlace_m) break;
            const auto &a = model.normals[i], &b = from.normals[near.index[k]];
            if (a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.5F) continue;
            taken.emplace_back(i, from.colours[near.index[k]].mean);
            break;
        }
    }
    for (const auto& [i, rgb] : taken) setColour(model, i, rgb);
}

}  // namespace djpete::texture
