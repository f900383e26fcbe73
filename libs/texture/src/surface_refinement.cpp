#include "surface_refinement.h"

#include <mrpt/maps/CSimplePointsMap.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

#include "voxel_key.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr std::size_t kNeighbours = 12;
constexpr double kReach_m = 0.25;     // neighbours farther away are of another part
constexpr double kMaxShift_m = 0.05;  // the sensor does not err by more
constexpr double kFlat = 0.15;        // thickness by width (squared) of what passes as a plane
constexpr double kMaxGap_m = 0.18;    // gaps between beams at some 20 m
constexpr double kOneSided = 0.55;    // mean direction to the neighbours at a border

/// The measured points around a place and the plane through them.
struct Patch {
    Vec3 mean{0, 0, 0}, normal{0, 0, 1};
    Vec3 towards{0, 0, 0};  ///< mean direction to the neighbours, 0..1: large at a border
    bool flat = false;
    std::size_t nearest = 0;
    double nearest_m = 0;
};

class Cloud {
  public:
    explicit Cloud(const std::vector<SurfacePoint>& points) : points_(points) {
        map_.reserve(points.size());
        for (const auto& p : points) {
            map_.insertPointFast(static_cast<float>(p.p_obj.x()), static_cast<float>(p.p_obj.y()),
                                 static_cast<float>(p.p_obj.z()));
        }
        map_.mark_as_modified();
    }

    Patch patchAt(const Vec3& at) const {
        std::vector<std::size_t> found;
        std::vector<float> distances2;
        map_.kdTreeNClosestPoint3DIdx(static_cast<float>(at.x()), static_cast<float>(at.y()),
                                      static_cast<float>(at.z()),
                                      std::min(kNeighbours, points_.size()), found, distances2);
        Patch out;
        out.nearest = found.front();
        out.nearest_m = std::sqrt(static_cast<double>(distances2.front()));
        const double width2 = std::max(1e-4, static_cast<double>(distances2.back()));
        double total = 0;
        geometry::Mat3 products = geometry::Mat3::Zero();
        Vec3 sum(0, 0, 0);
        std::size_t count = 0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            const auto d2 = static_cast<double>(distances2[k]);
            if (d2 > kReach_m * kReach_m) break;
            const Vec3 q = points_[found[k]].p_obj - at;
            const double w = std::exp(-d2 / width2);
            sum += w * q;
            products += w * q * q.transpose();
            total += w;
            if (d2 > 1e-8) out.towards += q / std::sqrt(d2);
            ++count;
        }
        if (count < 5) return out;
        out.towards /= static_cast<double>(count);
        const Vec3 offset = sum / total;
        out.mean = at + offset;
        Eigen::SelfAdjointEigenSolver<geometry::Mat3> solver;
        solver.computeDirect(products / total - offset * offset.transpose());
        out.flat = solver.eigenvalues()[0] < kFlat * solver.eigenvalues()[1];
        out.normal = solver.eigenvectors().col(0);
        return out;
    }

  private:
    const std::vector<SurfacePoint>& points_;
    mrpt::maps::CSimplePointsMap map_;
};

/// The place on the patch's plane; nothing if that is too far.
std::optional<Vec3> onto(const Patch& patch, const Vec3& p) {
    if (!patch.flat) return std::nullopt;
    const double off = patch.normal.dot(p - patch.mean);
    if (std::abs(off) > kMaxShift_m) return std::nullopt;
    return p - off * patch.normal;
}

}  // namespace

std::vector<SurfacePoint> refinedSurface(const std::vector<SurfacePoint>& points, double voxel_m,
                                         const FreeSpace& freeSpace, std::size_t maxPoints) {
    if (points.size() < kNeighbours) return points;
    const Cloud cloud(points);
    std::vector<SurfacePoint> out;
    std::vector<Patch> patches;
    std::unordered_set<uint64_t> taken;  // asked only, never walked through
    for (const SurfacePoint& point : points) {
        patches.push_back(cloud.patchAt(point.p_obj));
        SurfacePoint moved = point;
        moved.p_obj = onto(patches.back(), point.p_obj).value_or(point.p_obj);
        const auto key = voxelKey(moved.p_obj, voxel_m);
        if (!key || !taken.insert(*key).second) continue;
        out.push_back(moved);
    }
    const int steps = static_cast<int>(std::ceil(kMaxGap_m / 2 / voxel_m));
    for (std::size_t i = 0; i < points.size() && out.size() < maxPoints; ++i) {
        if (!patches[i].flat) continue;
        const Vec3& n = patches[i].normal;
        const Vec3 s = n.cross(std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
        const Vec3 t = n.cross(s);
        for (int a = -steps; a <= steps; ++a) {
            for (int b = -steps; b <= steps; ++b) {
                const Vec3 wanted = points[i].p_obj + voxel_m * (a * s + b * t);
                const auto first = voxelKey(wanted, voxel_m);
                if (!first || taken.count(*first) != 0) continue;
                const Patch patch = cloud.patchAt(wanted);
                const auto place = onto(patch, wanted);
                if (!place || patch.nearest_m > kMaxGap_m / 2 || patch.towards.norm() > kOneSided ||
                    freeSpace.isFree(*place)) {
                    continue;
                }
                const auto key = voxelKey(*place, voxel_m);
                if (!key || !taken.insert(*key).second) continue;
                SurfacePoint filled = points[patch.nearest];
                filled.p_obj = *place;
                out.push_back(filled);
                if (out.size() >= maxPoints) return out;
            }
        }
    }
    return out;
}

}  // namespace djpete::texture
