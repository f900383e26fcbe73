#include "edit_points.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

constexpr std::size_t kNeighbours = 9;  // and the point itself
constexpr double kSigmas = 2.5;
constexpr float kStrayColour = 60;  // grey levels
constexpr uint32_t kFewViews = 2;

float medianOf(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void denoise(ObjectModel& model, const Region& region) {
    if (model.size() <= kNeighbours) return;
    std::vector<double> spacing(model.size(), 0);
    std::vector<std::pair<std::size_t, std::array<float, 3>>> mended;
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto p = model.point(i);
        std::vector<std::size_t> index;
        std::vector<float> distance2;
        model.cloud->kdTreeNClosestPoint3DIdx(p[0], p[1], p[2], kNeighbours, index, distance2);
        for (const float d2 : distance2) {
            spacing[i] += std::sqrt(static_cast<double>(d2)) / (kNeighbours - 1);
        }
        sum += spacing[i];
        squares += spacing[i] * spacing[i];
        const ColourSum& own = model.colours[i];
        if (own.count == 0 || own.count > kFewViews || !region.contains(model, i)) continue;
        std::array<std::vector<float>, 3> near;
        for (const std::size_t k : index) {
            if (k == i || model.colours[k].count == 0) continue;
            for (std::size_t c = 0; c < 3; ++c) near[c].push_back(model.colours[k].mean[c]);
        }
        if (near[0].size() < 5) continue;
        std::array<float, 3> median{};
        float apart = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            median[c] = medianOf(near[c]);
            apart = std::max(apart, std::abs(median[c] - own.mean[c]));
        }
        if (apart > kStrayColour) mended.emplace_back(i, median);
    }
    for (const auto& [i, rgb] : mended) {
        ColourSum colour;
        colour.add(rgb, 1);
        model.colours[i] = colour;
        model.seenIn[i] = 0;
        model.flags[i] |= flag::kEdited;
        model.showColour(i);
    }
    const auto n = static_cast<double>(model.size());
    const double mean = sum / n, sigma = std::sqrt(std::max(0.0, squares / n - mean * mean));
    std::vector<bool> keep(model.size(), true);
    for (std::size_t i = 0; i < model.size(); ++i) {
        keep[i] = spacing[i] <= mean + kSigmas * sigma || !region.contains(model, i);
    }
    model = model.subset(keep);
}

}  // namespace djpete::texture
