#include "djpete/scans/prepared_scan.h"

#include <cmath>

#include "cells.h"

namespace djpete::scans {

namespace {

/// Which cubes were met; room for a number of them that is known beforehand.
class CellSet {
  public:
    explicit CellSet(std::size_t most) {
        std::size_t size = 64;
        while (size < 2 * most) size *= 2;
        cells_.assign(size, kFree);
    }
    /// True if it was not there.
    bool insert(uint64_t cell) {
        const std::size_t mask = cells_.size() - 1;
        for (std::size_t i = spread(cell) & mask;; i = (i + 1) & mask) {
            if (cells_[i] == cell) return false;
            if (cells_[i] != kFree) continue;
            cells_[i] = cell;
            return true;
        }
    }

  private:
    static constexpr uint64_t kFree = ~uint64_t{0};
    std::vector<uint64_t> cells_;
};

}  // namespace

PreparedScan prepareScan(const obs::LidarScan& scan, const ScanOptions& options) {
    PreparedScan out;
    out.T_vehicle_velo = scan.T_vehicle_velo;
    const double near2 = options.minRange_m * options.minRange_m;
    const double far2 = options.maxRange_m * options.maxRange_m;
    CellSet cells(scan.points.size());
    for (const auto& p : scan.points) {
        const Eigen::Vector3f point(p.x, p.y, p.z);
        const double range2 = static_cast<double>(point.squaredNorm());
        if (!(range2 >= near2 && range2 <= far2)) continue;  // NaN too
        if (cells.insert(cellOf(point, 1 / options.mapSpacing_m))) out.points.push_back(point);
    }
    CellSet wide(out.points.size());
    for (uint32_t i = 0; i < out.points.size(); ++i) {
        if (wide.insert(cellOf(out.points[i], 1 / options.matchSpacing_m)))
            out.toMatch.push_back(i);
    }
    return out;
}

std::vector<geometry::Vec3> atOneInstant(const PreparedScan& scan,
                                         const geometry::Vec6& twistPerSecond,
                                         const ScanOptions& options) {
    std::vector<geometry::Vec3> out;
    out.reserve(scan.points.size());
    for (const auto& point : scan.points) {
        out.push_back(scan.T_vehicle_velo * point.cast<double>());
    }
    if (options.spinPeriod_s <= 0) return out;
    // The motion of a fraction of a turn is small: motions of narrow sectors are near enough.
    constexpr int kSectors = 256;
    std::vector<geometry::SE3> motions;
    for (int s = 0; s < kSectors; ++s) {
        const double turn = (s + 0.5) / kSectors - 0.5;
        motions.push_back(geometry::SE3::exp(twistPerSecond * (turn * options.spinPeriod_s)));
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto& p = scan.points[i];
        const double turn = static_cast<double>(std::atan2(p.y(), p.x())) / (2 * M_PI) + 0.5;
        const int sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
        out[i] = motions[static_cast<std::size_t>(std::max(sector, 0))] * out[i];
    }
    return out;
}

}  // namespace djpete::scans
