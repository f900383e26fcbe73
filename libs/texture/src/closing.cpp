#include "closing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr double kBin_m = 0.1;
constexpr std::size_t kBinPoints = 40;  ///< fewer do not tell the silhouette
constexpr float kKnownWeight = 0.4F;    ///< of a corner about a radius from a lonely point
constexpr double kReach_m = 0.3;        ///< so far the known surface shapes its surroundings
constexpr float kSmallWeight = 1e-6F;   ///< of a corner whose distance is made up
constexpr int kSweeps = 120;
constexpr float kOverRelaxation = 1.6F;

/// The body that stands for what was not seen.
class PlainBody {
  public:
    explicit PlainBody(const ObjectModel& model) : half_(0.5 * model.size_m) {
        const auto bins = static_cast<std::size_t>(std::ceil(2 * half_.x() / kBin_m));
        std::vector<std::vector<double>> heights(std::max<std::size_t>(1, bins));
        for (std::size_t i = 0; i < model.size(); ++i) {
            const auto p = vec3(model.point(i));
            if (std::abs(p.x()) >= half_.x() || std::abs(p.z()) > half_.z() + kBin_m) continue;
            heights[binOf(p.x(), heights.size())].push_back(p.z());
        }
        for (auto& h : heights) {
            std::optional<double> top, bottom;
            if (h.size() >= kBinPoints) {
                std::sort(h.begin(), h.end());
                top = std::min(half_.z(), h[h.size() - 1 - h.size() / 50]);
                const double lowest = std::max(-half_.z(), h[h.size() / 50]);
                if (*top - lowest > half_.z()) bottom = lowest;  // not of a roof alone
            }
            top_.push_back(top);
            bottom_.push_back(bottom);
        }
        fill(top_, half_.z());
        fill(bottom_, -half_.z());
    }

    /// Positive outside; along the nearest axis, so a bound rather than the true distance.
    double distance(const Vec3& p) const {
        const double sides = std::max(std::abs(p.x()) - half_.x(), std::abs(p.y()) - half_.y());
        return std::max({sides, p.z() - at(top_, p.x()), at(bottom_, p.x()) - p.z()});
    }

  private:
    using Profile = std::vector<std::optional<double>>;

    std::size_t binOf(double x, std::size_t bins) const {
        const double bin = std::floor((x + half_.x()) / kBin_m);
        return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins - 1)));
    }

    /// Bins without points take the nearest one's value, or the box's.
    static void fill(Profile& profile, double box) {
        const Profile known = profile;
        for (std::size_t i = 0; i < known.size(); ++i) {
            for (std::size_t d = 0; d < known.size() && !profile[i]; ++d) {
                if (i >= d && known[i - d]) profile[i] = known[i - d];
                if (!profile[i] && i + d < known.size()) profile[i] = known[i + d];
            }
            if (!profile[i]) profile[i] = box;
        }
    }

    /// Linear between the bins' middles.
    double at(const Profile& profile, double x) const {
        const double last = static_cast<double>(profile.size() - 1);
        const double where = std::clamp((x + half_.x()) / kBin_m - 0.5, 0.0, last);
        const auto i = static_cast<std::size_t>(where);
        const std::size_t j = std::min(i + 1, profile.size() - 1);
        const double share = where - static_cast<double>(i);
        return (1 - share) * *profile[i] + share * *profile[j];
    }

    Vec3 half_;
    Profile top_, bottom_;
};

/// Distances at unknown corners: the mean of the neighbours', drawn towards the plain body.
class Smoothing {
  public:
    Smoothing(DistanceGrid& grid, const ObjectModel& model)
        : grid_(grid), size_(grid.corners()), limit_(static_cast<float>(3 * grid.voxel_m())) {
        const PlainBody body(model);
        const double pull = grid.voxel_m() / kReach_m;
        pull_ = static_cast<float>(pull * pull);
        forAll([&](int x, int y, int z, std::size_t i) {
            DistanceGrid::Corner& c = grid_.at(i);
            const Vec3 p = grid_.position(x, y, z);
            const bool edge = x == 0 || y == 0 || z == 0 || x + 1 == size_[0] ||
                              y + 1 == size_[1] || z + 1 == size_[2];
            const bool known = c.weight >= kKnownWeight && !edge;
            const double made =
                passed(model.freeSpace, body, p) ? grid.voxel_m() : body.distance(p);
            body_.push_back(std::clamp(static_cast<float>(made), -limit_, limit_));
            fixed_.push_back(known || edge);
            if (known) {
                c.distance = std::clamp(c.distance, -limit_, limit_);
            } else {
                c = {kSmallWeight, edge ? limit_ : body_.back(), {0, 0, 0}};
            }
        });
    }

    void run() {
        const std::size_t stepY = grid_.index(0, 1, 0), stepZ = grid_.index(0, 0, 1);
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            forAll([&](int, int, int, std::size_t i) {
                if (fixed_[i]) return;
                const auto d = [&](std::size_t k) { return grid_.at(k).distance; };
                const float around =
                    d(i - 1) + d(i + 1) + d(i - stepY) + d(i + stepY) + d(i - stepZ) + d(i + stepZ);
                const float want = (around + 6 * pull_ * body_[i]) / (6 + 6 * pull_);
                grid_.at(i).distance += kOverRelaxation * (want - grid_.at(i).distance);
            });
        }
        forAll([&](int, int, int, std::size_t i) {  // normals: up the slope
            DistanceGrid::Corner& c = grid_.at(i);
            if (fixed_[i]) return;
            const std::array<std::size_t, 3> step{1, stepY, stepZ};
            Vec3 slope;
            for (unsigned k = 0; k < 3; ++k) {
                slope[k] = static_cast<double>(grid_.at(i + step[k]).distance -
                                               grid_.at(i - step[k]).distance);
            }
            if (slope.norm() > 1e-9) c.normal = floats(slope.normalized() * c.weight);
        });
    }

  private:
    /// Rays along a surface pass cells that it cuts; so they must have passed farther in, too.
    static bool passed(const FreeSpace& space, const PlainBody& body, const Vec3& p) {
        if (!space.isFree(p)) return false;
        constexpr double kStep_m = 0.05;
        Vec3 outward;
        for (int k = 0; k < 3; ++k) {
            const Vec3 step = kStep_m * Vec3::Unit(k);
            outward[k] = body.distance(p + step) - body.distance(p - step);
        }
        if (!(outward.norm() > 1e-9)) return true;
        return space.isFree(p - static_cast<double>(FreeSpace::kCell_m) * outward.normalized());
    }

    template <class Visit>
    void forAll(Visit&& visit) const {
        std::size_t i = 0;
        for (int z = 0; z < size_[2]; ++z) {
            for (int y = 0; y < size_[1]; ++y) {
                for (int x = 0; x < size_[0]; ++x, ++i) visit(x, y, z, i);
            }
        }
    }

    DistanceGrid& grid_;
    std::array<int, 3> size_;
    float limit_, pull_ = 0;
    std::vector<float> body_;
    std::vector<bool> fixed_;
};

}  // namespace

void closeGaps(DistanceGrid& grid, const ObjectModel& model) {
    if (model.size() == 0) return;
    Smoothing(grid, model).run();
}

}  // namespace djpete::texture
