#include "lidar_depth.h"

#include <algorithm>
#include <cmath>

namespace djpete::frontend {

using geometry::Vec3;

namespace {

constexpr int kCell_px = 8;
constexpr double kMinDepth_m = 1.0;

}  // namespace

ProjectedScan::ProjectedScan(const obs::LidarScan& scan, const obs::RigCamera& camera,
                             const FrontendOptions& options)
    : options_(options),
      columns_(camera.model.width_px / kCell_px + 1),
      rows_(camera.model.height_px / kCell_px + 1),
      cells_(static_cast<std::size_t>(columns_ * rows_)) {
    const geometry::SE3 T_cam_velo = camera.T_vehicle_cam.inverse() * scan.T_vehicle_velo;
    for (const auto& point : scan.points) {
        const Vec3 p_cam = T_cam_velo * point.position();
        if (!(p_cam.z() > kMinDepth_m) || p_cam.z() > options.lidarMaxDepth_m) continue;
        const geometry::Vec2 uv = camera.model.project(p_cam);
        if (!camera.model.contains(uv)) continue;
        const int cell =
            static_cast<int>(uv.y()) / kCell_px * columns_ + static_cast<int>(uv.x()) / kCell_px;
        cells_[static_cast<std::size_t>(cell)].push_back({static_cast<float>(uv.x()),
                                                          static_cast<float>(uv.y()),
                                                          static_cast<float>(1.0 / p_cam.z())});
    }
}

const std::vector<ProjectedScan::Return>* ProjectedScan::cellAt(int column, int row) const {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nullptr;
    return &cells_[static_cast<std::size_t>(row * columns_ + column)];
}

std::optional<LidarDepth> ProjectedScan::depthAt(double u_px, double v_px) const {
    const double w = options_.lidarHalfWidth_px, h = options_.lidarHalfHeight_px;
    const auto cellOf = [](double x) { return static_cast<int>(std::floor(x / kCell_px)); };
    // 1/z = n0 + n1 du + n2 dv, du and dv scaled to [-1, 1]
    geometry::Mat3 A = geometry::Mat3::Zero();
    Vec3 b = Vec3::Zero();
    std::vector<Vec3> used;
    bool above = false, below = false, leftOf = false, rightOf = false;
    for (int row = cellOf(v_px - h); row <= cellOf(v_px + h); ++row) {
        for (int column = cellOf(u_px - w); column <= cellOf(u_px + w); ++column) {
            const auto* cell = cellAt(column, row);
            if (!cell) continue;
            for (const auto& r : *cell) {
                const double du = (r.u_px - u_px) / w, dv = (r.v_px - v_px) / h;
                if (std::abs(du) > 1 || std::abs(dv) > 1) continue;
                (dv < 0 ? above : below) = true;
                (du < 0 ? leftOf : rightOf) = true;
                const Vec3 x(1, du, dv);
                A += x * x.transpose();
                b += r.inverseDepth * x;
                used.emplace_back(du, dv, r.inverseDepth);
            }
        }
    }
    if (used.size() < 5 || !above || !below || !leftOf || !rightOf) return std::nullopt;
    A.diagonal().array() += 1e-9;
    const Vec3 n = A.ldlt().solve(b);
    if (!n.allFinite() || !(n.x() > 1.0 / options_.lidarMaxDepth_m)) return std::nullopt;
    double worst = 0, sum2 = 0;
    for (const auto& r : used) {
        const double e = std::abs(n.x() + n.y() * r.x() + n.z() * r.y() - r.z()) / n.x();
        worst = std::max(worst, e);
        sum2 += e * e;
    }
    if (worst > 2.5 * options_.lidarMaxResidual) return std::nullopt;
    const double relative = std::sqrt(sum2 / static_cast<double>(used.size()));
    if (relative > options_.lidarMaxResidual) return std::nullopt;
    const double depth = 1.0 / n.x();
    // The slope across one pixel of calibration error adds to the range's own noise.
    const double slope = std::hypot(n.y() / w, n.z() / h) * depth * depth;
    const double sigma = std::sqrt(options_.lidarSigma_m * options_.lidarSigma_m +
                                   relative * relative * depth * depth + 0.25 * slope * slope);
    return LidarDepth{static_cast<float>(depth), static_cast<float>(sigma)};
}

}  // namespace djpete::frontend
