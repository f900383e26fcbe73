#include "ground.h"

// Templates are instantiated here, for one point type: PCL's libraries hold them for all types and
// would take 30 MB of memory.
#define PCL_NO_PRECOMPILE
#include <pcl/ModelCoefficients.h>
#include <pcl/common/angles.h>
#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace djpete::observers {

namespace {

constexpr std::size_t kSectors = 72;        // 5 degrees: a car at 10 m spans four
constexpr float kRing_m = 2.0F;             // shorter than a car, so ground shows beside it
constexpr float kPlaneRange_m = 30.0F;      // one plane is asked to hold this far
constexpr double kPlaneThreshold_m = 0.15;  // kerbs and road camber
constexpr float kStepUp_m = 0.22F;          // ground rises by at most this from ring to ring
constexpr float kStepDown_m = 0.30F;        // and falls by at most this
constexpr float kTurn = 6.28318530718F;

std::size_t sectorOf(float x, float y) {
    const float turn = std::atan2(y, x) / kTurn + 0.5F;
    return std::min(kSectors - 1, static_cast<std::size_t>(turn * static_cast<float>(kSectors)));
}

/// The lowest point of every small polar cell near the sensor: mostly ground.
pcl::PointCloud<pcl::PointXYZ>::Ptr lowestPoints(const std::vector<obs::ScanPoint>& points,
                                                 float rangeMin_m) {
    constexpr std::size_t kFineSectors = 180;
    constexpr auto kFineRings = static_cast<std::size_t>(kPlaneRange_m);
    std::vector<const obs::ScanPoint*> lowest(kFineSectors * kFineRings, nullptr);
    for (const auto& p : points) {
        const float range = std::hypot(p.x, p.y);
        if (range < rangeMin_m || range >= kPlaneRange_m) continue;
        const float turn = std::atan2(p.y, p.x) / kTurn + 0.5F;
        const auto s = std::min(kFineSectors - 1, static_cast<std::size_t>(turn * kFineSectors));
        auto& slot = lowest[s * kFineRings + static_cast<std::size_t>(range)];
        if (slot == nullptr || p.z < slot->z) slot = &p;
    }
    auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    for (const auto* p : lowest) {
        if (p != nullptr) cloud->push_back({p->x, p->y, p->z});
    }
    return cloud;
}

/// Value of rank `share` (0..1); reorders `values`, which must not be empty.
float quantile(std::vector<float>& values, double share) {
    const auto at =
        values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace

std::optional<GroundModel> GroundModel::fit(const std::vector<obs::ScanPoint>& points,
                                            const geometry::Vec3& up, double slopeMax_deg,
                                            double rangeMin_m, double rangeMax_m) {
    const auto cloud = lowestPoints(points, static_cast<float>(rangeMin_m));
    if (cloud->size() < 20) return std::nullopt;
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // a failed fit is told by the result
    pcl::SACSegmentation<pcl::PointXYZ> sac(false);           // false: PCL's fixed seed
    sac.setModelType(pcl::SACMODEL_PERPENDICULAR_PLANE);
    sac.setMethodType(pcl::SAC_RANSAC);
    sac.setAxis(up.cast<float>());
    sac.setEpsAngle(pcl::deg2rad(slopeMax_deg));
    sac.setDistanceThreshold(kPlaneThreshold_m);
    sac.setMaxIterations(200);
    sac.setOptimizeCoefficients(true);
    sac.setInputCloud(cloud);
    pcl::PointIndices inliers;
    pcl::ModelCoefficients plane;
    sac.segment(inliers, plane);
    if (inliers.indices.size() < 20 || plane.values.size() != 4 ||
        std::abs(plane.values[2]) < 0.5F) {
        return std::nullopt;
    }
    GroundModel model;
    const float nz = plane.values[2];
    model.a_ = -plane.values[0] / nz;
    model.b_ = -plane.values[1] / nz;
    model.c_ = -plane.values[3] / nz;
    model.fitCells(points, rangeMin_m, rangeMax_m);
    model.smoothCells();
    return model;
}

void GroundModel::fitCells(const std::vector<obs::ScanPoint>& points, double rangeMin_m,
                           double rangeMax_m) {
    rings_ = static_cast<std::size_t>(std::ceil(rangeMax_m / kRing_m)) + 1;
    std::vector<std::vector<float>> seen(kSectors * rings_);
    for (const auto& p : points) {
        const float range = std::hypot(p.x, p.y);
        if (range < static_cast<float>(rangeMin_m) || range >= static_cast<float>(rangeMax_m))
            continue;
        const float over = overPlane(p.x, p.y, p.z);
        if (over > 4.0F) continue;
        const auto ring = static_cast<std::size_t>(range / kRing_m);
        seen[sectorOf(p.x, p.y) * rings_ + ring].push_back(over);
    }
    cells_.assign(kSectors * rings_, 0.F);
    for (std::size_t s = 0; s < kSectors; ++s) {
        float ground = 0;  // the plane holds where the sensor stands
        for (std::size_t r = 0; r < rings_; ++r) {
            auto& here = seen[s * rings_ + r];
            if (here.size() >= 5) {
                const float low = quantile(here, 0.05);
                if (low - ground < kStepUp_m && ground - low < kStepDown_m) ground = low;
            }
            cells_[s * rings_ + r] = ground;
        }
    }
}

/// Median over a 3x3 neighbourhood: a lone cell full of car does not lift the ground.
void GroundModel::smoothCells() {
    const std::vector<float> raw = cells_;
    std::vector<float> around;
    for (std::size_t s = 0; s < kSectors; ++s) {
        for (std::size_t r = 0; r < rings_; ++r) {
            around.clear();
            for (std::size_t ds : {kSectors - 1, std::size_t{0}, std::size_t{1}}) {
                const std::size_t row = (s + ds) % kSectors * rings_;
                for (std::size_t k = r == 0 ? 0 : r - 1; k <= std::min(r + 1, rings_ - 1); ++k) {
                    around.push_back(raw[row + k]);
                }
            }
            cells_[s * rings_ + r] = quantile(around, 0.5);
        }
    }
}

/// Linear along the ring direction, constant across a sector.
float GroundModel::correction(float x, float y) const {
    const float at = std::hypot(x, y) / kRing_m - 0.5F;
    const float clamped = std::clamp(at, 0.F, static_cast<float>(rings_ - 1));
    const auto r0 = static_cast<std::size_t>(clamped);
    const auto r1 = std::min(r0 + 1, rings_ - 1);
    const float share = clamped - static_cast<float>(r0);
    const std::size_t row = sectorOf(x, y) * rings_;
    return (1 - share) * cells_[row + r0] + share * cells_[row + r1];
}

double GroundModel::heightAt(double x, double y) const {
    const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
    return static_cast<double>(a_ * fx + b_ * fy + c_ + correction(fx, fy));
}

geometry::Vec3 GroundModel::normal() const {
    return geometry::Vec3(-static_cast<double>(a_), -static_cast<double>(b_), 1.0).normalized();
}

}  // namespace djpete::observers
