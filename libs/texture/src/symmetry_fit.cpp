#include <algorithm>
#include <array>
#include <cmath>

#include "djpete/texture/completion.h"
#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

using geometry::Vec3;

Vec3 SymmetryPlane::normal() const { return {-std::sin(yaw_rad), std::cos(yaw_rad), 0}; }

Vec3 SymmetryPlane::mirrored(const Vec3& p_obj) const {
    const Vec3 m = normal();
    return p_obj - 2 * (p_obj - Vec3(0, offset_m, 0)).dot(m) * m;
}

Vec3 SymmetryPlane::mirroredDirection(const Vec3& direction_obj) const {
    const Vec3 m = normal();
    return direction_obj - 2 * direction_obj.dot(m) * m;
}

namespace {

constexpr std::size_t kMaxSamples = 3000;
constexpr double kReach_m = 0.2;    ///< to a partner of a mirrored point
constexpr double kSpread_m = 0.04;  ///< of distances of a good match
constexpr double kSameNormal_cos = 0.7;
constexpr double kSideways_cos = 0.5;  ///< normals that tell the offset

struct Match {
    double distance_m = 0;
    bool sideways = false;
};

class Matcher {
  public:
    explicit Matcher(const ObjectModel& model)
        : model_(model), grid_(model, 0.1, [&](uint32_t i) { return seen(i); }) {
        std::vector<uint32_t> all;
        for (uint32_t i = 0; i < model.size(); ++i) {
            if (seen(i)) all.push_back(i);
        }
        const std::size_t step =
            std::max<std::size_t>(1, (all.size() + kMaxSamples - 1) / kMaxSamples);
        for (std::size_t k = 0; k < all.size(); k += step) samples_.push_back(all[k]);
    }

    std::size_t samples() const { return samples_.size(); }

    std::vector<Match> matches(const SymmetryPlane& plane) const {
        std::vector<Match> out;
        for (const uint32_t i : samples_) {
            const Vec3 p = plane.mirrored(vec3(model_.point(i)));
            const Vec3 n = plane.mirroredDirection(vec3(model_.normals[i]));
            double nearest2 = kReach_m * kReach_m * 2;
            double apart = 0;
            grid_.forWithin(p, kReach_m, [&](uint32_t j, double d2) {
                const Vec3 other = vec3(model_.normals[j]);
                if (d2 >= nearest2 || other.dot(n) < kSameNormal_cos) return;
                nearest2 = d2;
                apart = other.dot(p - vec3(model_.point(j)));
            });
            if (nearest2 > kReach_m * kReach_m) continue;
            out.push_back({std::abs(apart), std::abs(n.y()) > kSideways_cos});
        }
        return out;
    }

    /// The more points fall on others, the better; far ones neither help nor harm.
    double score(const SymmetryPlane& plane) const {
        double sum = 0;
        for (const Match& m : matches(plane)) {
            const double d = m.distance_m / kSpread_m;
            sum += std::exp(-0.5 * d * d);
        }
        return sum;
    }

  private:
    bool seen(uint32_t i) const { return (model_.flags[i] & flag::kInferredPoint) == 0; }

    const ObjectModel& model_;
    PointGrid grid_;
    std::vector<uint32_t> samples_;
};

/// Of points that face sideways: roof and bonnet fit wherever the plane is.
std::optional<double> medianDistance(std::vector<Match> matches) {
    matches.erase(
        std::remove_if(matches.begin(), matches.end(), [](const Match& m) { return !m.sideways; }),
        matches.end());
    if (matches.empty()) return std::nullopt;
    const auto middle = matches.begin() + static_cast<std::ptrdiff_t>(matches.size() / 2);
    std::nth_element(matches.begin(), middle, matches.end(),
                     [](const Match& a, const Match& b) { return a.distance_m < b.distance_m; });
    return middle->distance_m;
}

/// Grid search from coarse to fine within the limits; the first of equals wins.
SymmetryPlane bestPlane(const Matcher& matcher, const SymmetryOptions& options) {
    SymmetryPlane best;
    double bestScore = matcher.score(best);
    const auto tryGrid = [&](const SymmetryPlane& centre, int steps, double offset_m, double yaw) {
        for (int a = -steps; a <= steps; ++a) {
            for (int b = -steps; b <= steps; ++b) {
                const SymmetryPlane plane{centre.offset_m + a * offset_m, centre.yaw_rad + b * yaw};
                if (std::abs(plane.offset_m) > options.max_offset_m + 1e-9 ||
                    std::abs(plane.yaw_rad) > options.max_yaw_rad + 1e-9) {
                    continue;
                }
                const double score = matcher.score(plane);
                if (score <= bestScore) continue;
                bestScore = score;
                best = plane;
            }
        }
    };
    double offset_m = options.max_offset_m / 5, yaw_rad = options.max_yaw_rad / 5;
    tryGrid({}, 5, offset_m, yaw_rad);
    for (int k = 0; k < 4; ++k) {
        offset_m /= 2;
        yaw_rad /= 2;
        tryGrid(SymmetryPlane(best), 1, offset_m, yaw_rad);
    }
    return best;
}

}  // namespace

SymmetryFit fitSymmetry(const ObjectModel& model, const SymmetryOptions& options) {
    SymmetryFit fit;
    const Matcher matcher(model);
    if (matcher.samples() == 0) return fit;
    fit.box_distance_m = medianDistance(matcher.matches({}));
    const SymmetryPlane best = bestPlane(matcher, options);
    const auto matches = matcher.matches(best);
    std::size_t telling = 0;
    for (const Match& m : matches) telling += m.sideways && m.distance_m < 2 * kSpread_m ? 1U : 0U;
    fit.overlap = static_cast<double>(telling) / static_cast<double>(matcher.samples());
    const bool atLimit = std::abs(best.offset_m) > 0.999 * options.max_offset_m ||
                         std::abs(best.yaw_rad) > 0.999 * options.max_yaw_rad;
    fit.refined = fit.overlap >= options.min_overlap && telling >= 20 && !atLimit;
    if (fit.refined) {
        fit.plane = best;
        fit.distance_m = medianDistance(matches);
    } else {
        fit.distance_m = fit.box_distance_m;
    }
    return fit;
}

}  // namespace djpete::texture
