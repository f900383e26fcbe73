#include <algorithm>
#include <cmath>

#include "edits.h"
#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;
using Rgb = std::array<float, 3>;

constexpr double kReach_m = 0.12;         ///< of smoothing
constexpr double kSpread_m = 0.05;        ///< of smoothing, along the surface
constexpr double kColourSpread = 30;      ///< of smoothing; larger steps of colour are edges
constexpr double kReplaceReach_m = 0.35;  ///< to the other object's points

float luminance(const Rgb& c) { return 0.299F * c[0] + 0.587F * c[1] + 0.114F * c[2]; }

float medianLuminance(const ObjectModel& model, const Mask& in) {
    std::vector<float> values;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (in[i] && model.colours[i].count > 0) {
            values.push_back(luminance(model.colours[i].mean));
        }
    }
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// `paint` under so much light; more than it can reflect goes towards white.
Rgb lit(const Rgb& paint, float light) {
    Rgb out{};
    for (std::size_t c = 0; c < 3; ++c) out[c] = paint[c] * light;
    const float largest = *std::max_element(out.begin(), out.end());
    if (largest <= 255) return out;
    const float wanted = luminance(out);
    for (float& c : out) c *= 255 / largest;
    const float have = luminance(out);
    const float white = std::clamp((wanted - have) / std::max(1.0F, 255 - have), 0.0F, 1.0F);
    for (float& c : out) c += white * (255 - c);
    return out;
}

}  // namespace

void setColour(ObjectModel& model, std::size_t point, const Rgb& rgb) {
    ColourSum& sum = model.colours[point];
    if (sum.count == 0) {
        sum.add(rgb, 1.0F);
    } else {
        sum.mean = rgb;
    }
    model.flags[point] |= flag::kEdited;
    model.showColour(point);
}

/// Glass, rubber and grilles are not painted.
void recolour(ObjectModel& model, const Mask& in, const Rgb& rgb, EditReport& report) {
    Mask painted = in;
    for (std::size_t i = 0; i < model.size(); ++i) {
        painted[i] = in[i] && model.colours[i].count > 0 && (model.flags[i] & flag::kDarkPart) == 0;
    }
    const float reference = std::max(1.0F, medianLuminance(model, painted));
    Rgb paint = rgb;
    for (float& c : paint) c = std::max(c, 8.0F);  // black paint shows light and shade too
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!painted[i]) continue;
        setColour(model, i, lit(paint, luminance(model.colours[i].mean) / reference));
        if (!model.albedo.empty()) {
            for (std::size_t c = 0; c < 3; ++c) {
                model.albedo[i][c] =
                    static_cast<uint8_t>(std::lround(std::clamp(rgb[c], 0.0F, 255.0F)));
            }
        }
        ++report.changed;
    }
}

void brush(ObjectModel& model, const Mask& in, const Rgb& rgb, EditReport& report) {
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!in[i]) continue;
        setColour(model, i, rgb);
        ++report.changed;
    }
}

void smoothColours(ObjectModel& model, const Mask& in, unsigned passes, EditReport& report) {
    const PointGrid grid(model, 0.1, [&](uint32_t i) { return model.colours[i].count > 0; });
    std::vector<Rgb> now(model.size());
    for (std::size_t i = 0; i < model.size(); ++i) now[i] = model.colours[i].mean;
    for (unsigned pass = 0; pass < passes; ++pass) {
        std::vector<Rgb> next = now;
        for (uint32_t i = 0; i < model.size(); ++i) {
            if (!in[i] || model.colours[i].count == 0) continue;
            const Vec3 n = vec3(model.normals[i]), colour = vec3(now[i]);
            Vec3 sum = Vec3::Zero();
            double total = 0;
            grid.forWithin(vec3(model.point(i)), kReach_m, [&](uint32_t j, double d2) {
                const double facing = n.dot(vec3(model.normals[j]));
                if (facing < 0.5) return;
                const double apart2 = (vec3(now[j]) - colour).squaredNorm();
                const double weight =
                    facing * std::exp(-d2 / (2 * kSpread_m * kSpread_m) -
                                      apart2 / (2 * kColourSpread * kColourSpread));
                sum += weight * vec3(now[j]);
                total += weight;
            });
            if (total > 0) next[i] = floats(sum / total);
        }
        now = std::move(next);
    }
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!in[i] || now[i] == model.colours[i].mean) continue;
        setColour(model, i, now[i]);
        ++report.changed;
    }
}

void replaceColours(ObjectModel& model, const Mask& in, const ObjectModel& other,
                    EditReport& report) {
    const Vec3 scale = other.size_m.cwiseQuotient(model.size_m);
    const PointGrid grid(other, 0.15, [&](uint32_t i) { return other.colours[i].count > 0; });
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!in[i]) continue;
        const Vec3 p = vec3(model.point(i)).cwiseProduct(scale), n = vec3(model.normals[i]);
        double nearest2 = -1;
        const auto alike = [&](uint32_t j) { return n.dot(vec3(other.normals[j])) > 0.5; };
        grid.forWithin(p, kReplaceReach_m, [&](uint32_t j, double d2) {
            if (alike(j) && (nearest2 < 0 || d2 < nearest2)) nearest2 = d2;
        });
        if (nearest2 < 0) continue;
        Vec3 sum = Vec3::Zero();
        double total = 0;
        constexpr double kBlend_m = 0.025;
        grid.forWithin(p, std::sqrt(nearest2) + 3 * kBlend_m, [&](uint32_t j, double d2) {
            if (!alike(j)) return;
            const double further = std::sqrt(d2) - std::sqrt(nearest2);
            const double weight = std::exp(-further * further / (2 * kBlend_m * kBlend_m));
            sum += weight * vec3(other.colours[j].mean);
            total += weight;
        });
        setColour(model, i, floats(sum / total));
        model.flags[i] = static_cast<uint8_t>(model.flags[i] & ~flag::kInferredColour);
        ++report.changed;
    }
}

}  // namespace djpete::texture
