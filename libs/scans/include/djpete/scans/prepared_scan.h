/// A scan thinned out for matching.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "djpete/obs/sensor_frame.h"
#include "djpete/scans/options.h"

namespace djpete::scans {

/// Points in `velo`, in the order of the scan.
struct PreparedScan {
    std::vector<Eigen::Vector3f> points;  ///< one per cube of map_spacing_m
    std::vector<uint32_t> toMatch;        ///< those, by index, of one per cube of match_spacing_m
    geometry::SE3 T_vehicle_velo;
};

/// Keeps the first point of each cube. Points out of range or not finite are left out. Pure; needs
/// no pose, so it may run while the front end works.
PreparedScan prepareScan(const obs::LidarScan& scan, const ScanOptions& options);

/// The points in `vehicle` at the instant at which the scanner looked ahead, for a vehicle that
/// moves with this twist per second (its own frame). Does nothing else if spin_period_s is 0.
std::vector<geometry::Vec3> atOneInstant(const PreparedScan& scan,
                                         const geometry::Vec6& twistPerSecond,
                                         const ScanOptions& options);

}  // namespace djpete::scans
