#include <algorithm>
#include <array>
#include <cmath>

#include "djpete/texture/completion.h"
#include "facing.h"
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

constexpr std::size_t kMaxSamples = 2000;
constexpr double kReach_m = 0.2;    ///< to a partner of a mirrored point
constexpr double kSpread_m = 0.03;  ///< of distances of a good match, at most
constexpr double kLeastSpread_m = 0.01;
constexpr double kTellingDistance_m = 0.08;  ///< farther matches tell nothing
constexpr double kSameNormal_cos = 0.7;
constexpr double kSideways_cos = 0.5;  ///< normals that tell the offset

// Boxes are seldom worse than this; it keeps a plane that few points tell near the box's.
constexpr double kBoxOffset_m = 0.05, kBoxYaw_rad = 0.0175;
constexpr double kTrustInBox = 0.03;  ///< share of the points that one such step is worth

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

    /// The more points fall on others, the better, far ones neither help nor harm; and the nearer
    /// to the box's plane.
    double score(const SymmetryPlane& plane, double spread_m) const {
        double sum = 0;
        for (const Match& m : matches(plane)) {
            const double d = m.distance_m / spread_m;
            sum += std::exp(-0.5 * d * d);
        }
        const double offset = plane.offset_m / kBoxOffset_m, yaw = plane.yaw_rad / kBoxYaw_rad;
        const double distrust = 0.5 * kTrustInBox * (offset * offset + yaw * yaw);
        return sum - distrust * static_cast<double>(samples_.size());
    }

  private:
    bool seen(uint32_t i) const {
        return (model_.flags[i] & flag::kInferredPoint) == 0 &&
               !facesInwards(vec3(model_.point(i)), vec3(model_.normals[i]));
    }

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
class Search {
  public:
    Search(const Matcher& matcher, const SymmetryOptions& options)
        : matcher_(matcher), options_(options) {}

    SymmetryPlane run() {
        start({}, kSpread_m);
        const double offset_m = options_.max_offset_m / 5, yaw_rad = options_.max_yaw_rad / 5;
        tryGrid(5, offset_m, yaw_rad);
        for (int k = 1; k <= 3; ++k) tryGrid(1, std::ldexp(offset_m, -k), std::ldexp(yaw_rad, -k));
        // Again nearby, as sharply as the points are.
        const double noise_m = medianDistance(matcher_.matches(best_)).value_or(kSpread_m);
        start(best_, std::clamp(1.5 * noise_m, kLeastSpread_m, kSpread_m));
        for (int k = 2; k <= 4; ++k) tryGrid(2, std::ldexp(offset_m, -k), std::ldexp(yaw_rad, -k));
        return best_;
    }

  private:
    void start(const SymmetryPlane& plane, double spread_m) {
        best_ = plane;
        spread_m_ = spread_m;
        bestScore_ = matcher_.score(plane, spread_m);
    }

    void tryGrid(int steps, double offset_m, double yaw_rad) {
        const SymmetryPlane centre = best_;
        for (int a = -steps; a <= steps; ++a) {
            for (int b = -steps; b <= steps; ++b) {
                const SymmetryPlane plane{centre.offset_m + a * offset_m,
                                          centre.yaw_rad + b * yaw_rad};
                if (std::abs(plane.offset_m) > options_.max_offset_m + 1e-9 ||
                    std::abs(plane.yaw_rad) > options_.max_yaw_rad + 1e-9) {
                    continue;
                }
                const double score = matcher_.score(plane, spread_m_);
                if (score <= bestScore_) continue;
                bestScore_ = score;
                best_ = plane;
            }
        }
    }

    const Matcher& matcher_;
    const SymmetryOptions& options_;
    SymmetryPlane best_;
    double spread_m_ = kSpread_m, bestScore_ = 0;
};

}  // namespace

SymmetryFit fitSymmetry(const ObjectModel& model, const SymmetryOptions& options) {
    SymmetryFit fit;
    const Matcher matcher(model);
    if (matcher.samples() == 0) return fit;
    fit.box_distance_m = medianDistance(matcher.matches({}));
    const SymmetryPlane best = Search(matcher, options).run();
    const auto matches = matcher.matches(best);
    std::size_t telling = 0;
    for (const Match& m : matches)
        telling += m.sideways && m.distance_m < kTellingDistance_m ? 1U : 0U;
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
