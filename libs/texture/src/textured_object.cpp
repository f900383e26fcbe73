#include "textured_object.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "point_colour.h"
#include "surface_refinement.h"

namespace djpete::texture {

namespace {

using geometry::SE3;

constexpr float kLeastSharpness = 0.3F;
constexpr float kSaturated = 250, kSaturatedWeight = 0.2F;
constexpr float kDarkest = 15, kBrightest = 235;  // between them brightness tells of exposure
constexpr std::size_t kExposurePoints = 2000;     // per pair of views
constexpr std::size_t kLeastCommon = 20;
constexpr double kRatioSigma = 0.15, kMostIndependent = 0.01;

bool wellExposed(const std::array<float, 3>& rgb) {
    return *std::min_element(rgb.begin(), rgb.end()) >= kDarkest &&
           *std::max_element(rgb.begin(), rgb.end()) <= kBrightest;
}

float brightness(const std::array<float, 3>& rgb) { return rgb[0] + rgb[1] + rgb[2]; }

bool apart(const SE3& a, const SE3& b, double distance_m, double angle_deg) {
    const SE3 T_a_b = a.inverse() * b;
    return T_a_b.translation().norm() > distance_m || T_a_b.angle_rad() > angle_deg * M_PI / 180;
}

std::optional<ExposurePair> ratioOf(const KeptView& a, const KeptView& b) {
    const std::size_t points = std::min(a.samples.size(), b.samples.size());
    std::vector<double> logs;
    for (std::size_t i = 0; i < points; ++i) {
        if (a.samples[i] == 0 || b.samples[i] == 0) continue;
        const auto inA = colourOf(a.samples[i]), inB = colourOf(b.samples[i]);
        if (!wellExposed(inA) || !wellExposed(inB)) continue;
        logs.push_back(std::log(static_cast<double>(brightness(inA) / brightness(inB))));
        if (logs.size() == kExposurePoints) break;
    }
    if (logs.size() < kLeastCommon) return std::nullopt;
    const auto middle = logs.begin() + static_cast<std::ptrdiff_t>(logs.size() / 2);
    std::nth_element(logs.begin(), middle, logs.end());
    const double independent = std::min(kMostIndependent, static_cast<double>(logs.size()));
    return ExposurePair{a.frame, b.frame, *middle, independent / (kRatioSigma * kRatioSigma)};
}

}  // namespace

TexturedObject::TexturedObject(ObjectModel& model, const TextureOptions& options)
    : options_(options), grower_(model, options.voxel_m) {}

std::size_t TexturedObject::insert(std::vector<SurfacePoint> points, obs::FrameId frame,
                                   const SE3& T_cam_obj, std::size_t maxPoints) {
    if (points.empty()) return 0;
    for (auto& point : points) point.source = static_cast<uint32_t>(sources_.size());
    const std::size_t added = grower_.insert(points, maxPoints);
    if (added == 0) return 0;
    sources_.push_back({frame, T_cam_obj});
    sampled_ = views_.empty();
    refined_ = false;
    return added;
}

std::optional<std::size_t> TexturedObject::indexOf(obs::FrameId frame) const {
    const auto at = std::lower_bound(views_.begin(), views_.end(), frame,
                                     [](const KeptView& v, obs::FrameId f) { return v.frame < f; });
    if (at == views_.end() || at->frame != frame) return std::nullopt;
    return static_cast<std::size_t>(at - views_.begin());
}

/// Renews the model's list of views, and their bits where the order changed.
void TexturedObject::nameViews() {
    ObjectModel& m = model();
    std::vector<obs::FrameId> names;
    for (const auto& view : views_) names.push_back(view.frame);
    if (names.size() > m.views.size() &&
        std::equal(m.views.begin(), m.views.end(), names.begin())) {
        m.views = std::move(names);
        return;
    }
    // Both lists rise, so runs of bits move together: the bits in `mask` by so many places.
    struct Run {
        uint32_t mask = 0;
        int up = 0;
    };
    std::vector<Run> runs;
    for (std::size_t k = 0; k < m.views.size(); ++k) {
        const auto at = std::lower_bound(names.begin(), names.end(), m.views[k]);
        if (at == names.end() || *at != m.views[k]) continue;
        const int up = static_cast<int>(at - names.begin()) - static_cast<int>(k);
        if (runs.empty() || runs.back().up != up) runs.push_back({0, up});
        runs.back().mask |= 1U << k;
    }
    for (uint32_t& seen : m.seenIn) {
        uint32_t renamed = 0;
        for (const Run& run : runs) {
            const uint32_t bits = seen & run.mask;
            renamed |= run.up >= 0 ? bits << run.up : bits >> -run.up;
        }
        seen = renamed;
    }
    m.views = std::move(names);
}

void TexturedObject::eraseView(std::size_t index) {
    views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(index));
    nameViews();
}

std::size_t TexturedObject::addView(KeptView view) {
    const std::size_t samples = view.sampled;
    if (const auto same = indexOf(view.frame)) eraseView(*same);
    if (samples == 0) return 0;
    const auto at = std::upper_bound(views_.begin(), views_.end(), view.frame,
                                     [](obs::FrameId f, const KeptView& v) { return f < v.frame; });
    views_.insert(at, std::move(view));
    keepBest(std::min<std::size_t>(options_.max_views_per_object, ObjectModel::kMaxViews));
    return samples;
}

void TexturedObject::keepBest(std::size_t most) {
    while (views_.size() > std::max<std::size_t>(1, most)) {
        // What a view adds: its share of the weight of every point that it shows.
        std::vector<double> share(views_.size(), 0);
        std::vector<uint32_t> weights(views_.size());
        for (std::size_t i = 0; i < model().size(); ++i) {
            uint32_t total = 0;
            for (std::size_t k = 0; k < views_.size(); ++k) {
                weights[k] = views_[k].sampleOf(i) >> 24U;
                total += weights[k];
            }
            if (total == 0) continue;
            const double whole = 1.0 / total;
            for (std::size_t k = 0; k < views_.size(); ++k) share[k] += whole * weights[k];
        }
        const auto least = std::min_element(share.begin(), share.end()) - share.begin();
        views_.erase(views_.begin() + least);
        allStale_ = true;
    }
    nameViews();
}

std::vector<ToCommonScale> TexturedObject::toCommonScale(const ExposureMap& exposures) const {
    std::vector<ToCommonScale> out;
    for (const auto& view : views_) {
        const auto known = exposures.find(view.frame);
        out.emplace_back(known == exposures.end() ? Exposure() : known->second);
    }
    return out;
}

std::vector<float> TexturedObject::sharpnessFactors() const {
    float sharpest = 0;
    for (const auto& view : views_) sharpest = std::max(sharpest, view.sharpness);
    std::vector<float> out;
    for (const auto& view : views_) {
        out.push_back(sharpest > 0 ? std::max(kLeastSharpness, view.sharpness / sharpest) : 1.0F);
    }
    return out;
}

void TexturedObject::collect(obs::FrameId frame, const ExposureMap& exposures,
                             ExposureSamples& out) const {
    const auto own = indexOf(frame);
    if (!own) return;
    const std::vector<ToCommonScale> toCommon = toCommonScale(exposures);
    const auto& mine = views_[*own];
    const std::size_t step = std::max<std::size_t>(1, mine.sampled / kExposurePoints);
    std::size_t met = 0;
    for (std::size_t i = 0; i < mine.samples.size(); ++i) {
        if (mine.samples[i] == 0 || met++ % step != 0) continue;
        const auto shown = colourOf(mine.samples[i]);
        if (!wellExposed(shown)) continue;
        std::array<float, 3> sum{};
        float total = 0;
        for (std::size_t k = 0; k < views_.size(); ++k) {
            const PackedSample sample = k == *own ? 0 : views_[k].sampleOf(i);
            if (sample == 0) continue;
            const auto rgb = colourOf(sample);
            if (!wellExposed(rgb)) continue;
            const auto common = toCommon[k].of(rgb);
            const float w = weightOf(sample);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += w * common[c];
            total += w;
        }
        if (total <= 0) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            out.common.push_back(sum[c] / total);
            out.shown.push_back(shown[c]);
            out.weight.push_back(weightOf(mine.samples[i]));
        }
    }
}

void TexturedObject::collect(std::vector<ExposurePair>& out) const {
    for (std::size_t step = 1; step < views_.size(); step *= 2) {
        for (std::size_t k = 0; k + step < views_.size(); ++k) {
            if (auto pair = ratioOf(views_[k], views_[k + step])) out.push_back(*pair);
        }
    }
}

void TexturedObject::recolour(const ExposureMap& exposures, std::optional<obs::FrameId> frame) {
    if (allStale_) frame.reset();
    const auto only = frame ? indexOf(*frame) : std::nullopt;
    if (frame && !only) return;
    allStale_ = false;
    const std::vector<ToCommonScale> toCommon = toCommonScale(exposures);
    const auto sharpness = sharpnessFactors();
    ObjectModel& m = model();
    std::array<ColourSample, ObjectModel::kMaxViews> samples;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (only && views_[*only].sampleOf(i) == 0) continue;
        std::size_t count = 0;
        for (std::size_t k = 0; k < views_.size(); ++k) {
            const PackedSample packed = views_[k].sampleOf(i);
            if (packed == 0) continue;
            const auto rgb = colourOf(packed);
            const bool saturated = *std::max_element(rgb.begin(), rgb.end()) >= kSaturated;
            const float weight =
                weightOf(packed) * sharpness[k] * (saturated ? kSaturatedWeight : 1.0F);
            auto common = toCommon[k].of(rgb);
            for (float& c : common) c = std::clamp(c, 0.0F, 255.0F);
            samples[count++] = {common, weight, static_cast<unsigned>(k)};
        }
        const PointColour colour = robustColour(samples.data(), count);
        m.colours[i] = colour.sum;
        m.seenIn[i] = colour.seenIn;
        m.showColour(i);
    }
}

void TexturedObject::refine(std::size_t maxPoints) {
    if (refined_ || !options_.refine) return;
    refined_ = true;
    const std::size_t size = model().size();
    std::vector<unsigned> against(size, 0), inFavour(size, 0);
    for (const KeptView& view : views_) {
        const auto outside = contradicted(model(), view);
        for (std::size_t i = 0; i < size; ++i) {
            against[i] += outside[i] ? 1 : 0;
            inFavour[i] += view.sampleOf(i) != 0 ? 1 : 0;
        }
    }
    std::vector<SurfacePoint> points;
    const auto all = grower_.points();
    for (std::size_t i = 0; i < size; ++i) {
        const bool gone = inFavour[i] == 0 ? against[i] > 0 : 2 * against[i] > inFavour[i];
        if (!gone) points.push_back(all[i]);
    }
    grower_.replace(refinedSurface(points, options_.voxel_m, model().freeSpace, maxPoints));
    sampled_ = false;
    allStale_ = true;
}

void TexturedObject::resample() {
    if (sampled_) return;
    sampled_ = true;
    for (auto& view : views_) sampleView(model(), options_, view);
}

bool TexturedObject::follow(const std::function<std::optional<SE3>(obs::FrameId)>& T_cam_obj,
                            bool exact) {
    const double distance_m = exact ? 1e-4 : options_.follow_distance_m;
    const double angle_deg = exact ? 1e-3 : options_.follow_angle_deg;
    const auto left = [&](obs::FrameId frame, const SE3& before) {
        const auto now = T_cam_obj(frame);
        return now && apart(before, *now, distance_m, angle_deg);
    };
    const bool moved = std::any_of(sources_.begin(), sources_.end(),
                                   [&](const Source& s) { return left(s.frame, s.T_cam_obj); }) ||
                       std::any_of(views_.begin(), views_.end(),
                                   [&](const KeptView& v) { return left(v.frame, v.T_cam_obj); });
    if (!moved) return false;
    std::vector<SE3> T_new_old(sources_.size());
    for (std::size_t k = 0; k < sources_.size(); ++k) {
        const auto now = T_cam_obj(sources_[k].frame);
        if (!now) continue;
        T_new_old[k] = now->inverse() * sources_[k].T_cam_obj;
        sources_[k].T_cam_obj = *now;
    }
    auto points = grower_.points();
    for (auto& point : points) {
        const SE3& T = T_new_old[point.source];
        point.p_obj = T * point.p_obj;
        point.towardsSensor_obj = T.rotation() * point.towardsSensor_obj;
    }
    grower_.replace(points);
    for (auto& view : views_) view.T_cam_obj = T_cam_obj(view.frame).value_or(view.T_cam_obj);
    sampled_ = false;
    allStale_ = true;
    return true;
}

void TexturedObject::absorb(const TexturedObject& other, const SE3& T_this_other,
                            std::size_t maxPoints) {
    auto points = other.grower_.points();
    for (auto& point : points) {
        point.p_obj = T_this_other * point.p_obj;
        point.towardsSensor_obj = T_this_other.rotation() * point.towardsSensor_obj;
        point.source += static_cast<uint32_t>(sources_.size());
    }
    grower_.insert(points, maxPoints);
    const SE3 T_other_this = T_this_other.inverse();
    for (Source source : other.sources_) {
        source.T_cam_obj = source.T_cam_obj * T_other_this;
        sources_.push_back(source);
    }
    for (KeptView view : other.views_) {
        if (indexOf(view.frame)) continue;
        view.T_cam_obj = view.T_cam_obj * T_other_this;
        view.samples.clear();
        const auto at =
            std::upper_bound(views_.begin(), views_.end(), view.frame,
                             [](obs::FrameId f, const KeptView& v) { return f < v.frame; });
        views_.insert(at, std::move(view));
    }
    refined_ = sampled_ = false;
    resample();
    keepBest(std::min<std::size_t>(options_.max_views_per_object, ObjectModel::kMaxViews));
}

std::size_t TexturedObject::viewBytes() const {
    std::size_t total = 0;
    for (const auto& view : views_) total += view.bytes();
    return total;
}

}  // namespace djpete::texture
