#include "scan_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace djpete::scans {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

/// The prediction holds what nothing else holds: 1-sigma in metres and radians.
constexpr double kPrediction_m = 1.0, kPrediction_rad = 0.05;
/// Smaller steps end the iterations.
constexpr double kStep_m = 2e-4, kStep_rad = 1e-5;

struct System {
    Mat6 H = Mat6::Zero();
    Vec6 b = Vec6::Zero();
    double weight = 0, chi2 = 0, square = 0;  ///< sums of robust weights, of them times errors
    std::size_t matched = 0;
};

/// With T <- T exp(x), x = (rho, phi): the distance n (T p - m) changes by a rho + (p x a) phi,
/// a = R^T n.
System linearise(const std::vector<Vec3>& points, PlaneMap& map, const SE3& T, double kernel_m,
                 const ScanOptions& options) {
    System out;
    const double range2 = options.rangeSigma_m * options.rangeSigma_m;
    for (const Vec3& p : points) {
        const Vec3 p_map = T * p;
        const Plane* plane = map.planeAt(p_map);
        if (!plane) continue;
        const double r = plane->normal.dot(p_map - plane->mean);
        const double variance = range2 + plane->variance;
        // The kernel is never narrower than the points scatter.
        const double c2 = kernel_m * kernel_m + variance;
        if (r * r > 9 * c2) continue;
        const double half = c2 / (c2 + r * r);
        const double robust = half * half, w = robust / variance;
        const Vec3 a = T.rotation().transpose() * plane->normal;
        Vec6 J;
        J << a, p.cross(a);
        out.H.selfadjointView<Eigen::Lower>().rankUpdate(J, w);
        out.b -= w * r * J;
        out.weight += robust;
        out.chi2 += w * r * r;
        out.square += robust * r * r;
        ++out.matched;
    }
    out.H = out.H.selfadjointView<Eigen::Lower>();
    return out;
}

}  // namespace

std::optional<Alignment> align(const std::vector<Vec3>& points, PlaneMap& map,
                               const SE3& T_map_vehicle_predicted, double kernel_m,
                               const ScanOptions& options) {
    const double enough = std::max(double(options.minMatched),
                                   options.minMatchedRatio * static_cast<double>(points.size()));
    Vec6 held;
    held << Vec3::Constant(1 / (kPrediction_m * kPrediction_m)),
        Vec3::Constant(1 / (kPrediction_rad * kPrediction_rad));
    SE3 T = T_map_vehicle_predicted;
    for (unsigned i = 0; i < options.iterations; ++i) {
        const System s = linearise(points, map, T, kernel_m, options);
        if (static_cast<double>(s.matched) < enough) return std::nullopt;
        const Vec6 away = (T_map_vehicle_predicted.inverse() * T).log();
        const Mat6 H = s.H + Mat6(held.asDiagonal());
        const Vec6 step = H.ldlt().solve(s.b - held.cwiseProduct(away));
        if (!step.allFinite()) return std::nullopt;
        T = (T * SE3::exp(step)).normalised();
        if (step.head<3>().norm() < kStep_m && step.tail<3>().norm() < kStep_rad) break;
    }
    const System s = linearise(points, map, T, kernel_m, options);
    if (static_cast<double>(s.matched) < enough || !(s.weight > 0)) return std::nullopt;
    Alignment out;
    out.T_map_vehicle = T;
    // Scatter larger than expected makes all of it less certain.
    out.information = s.H / std::max(s.chi2 / s.weight, 1.0);
    out.matched = s.matched;
    out.rms_m = std::sqrt(s.square / s.weight);
    return out;
}

}  // namespace djpete::scans
