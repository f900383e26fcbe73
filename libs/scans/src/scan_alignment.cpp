#include "scan_alignment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace djpete::scans {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

/// Smaller steps end the iterations.
constexpr double kStep_m = 2e-4, kStep_rad = 1e-5;

/// Information of a direction that nothing holds: 1-sigma of 10 m.
constexpr double kNothing = 0.01;
/// Times what noise alone would say.
constexpr double kClearly = 5;
constexpr double kLever_m = 10;
/// The scatter of points against what is expected of it, at least.
constexpr double kLeastScatter = 0.1;

struct System {
    Mat6 H = Mat6::Zero();
    Mat6 noise = Mat6::Zero();  ///< the part of H that uncertain normals alone bring about
    Vec6 b = Vec6::Zero();
    double weight = 0, chi2 = 0, square = 0;  ///< sums of robust weights, of them times errors
    std::size_t matched = 0;
    /// Of b, by block of neighbouring points; only if asked for.
    std::vector<std::pair<uint64_t, Vec6>> pulls;
};

/// With T <- T exp(x), x = (rho, phi): the distance n (T p - m) changes by a rho + (p x a) phi,
/// a = R^T n.
System linearise(const std::vector<Vec3>& points, PlaneMap& map, const SE3& T, double kernel_m,
                 const ScanOptions& options, bool withPulls = false) {
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
        Eigen::Matrix<double, 6, 3> B;
        B << T.rotation().transpose(), geometry::skew(p) * T.rotation().transpose();
        out.noise += w * B * plane->tilt * B.transpose();
        out.b -= w * r * J;
        if (withPulls) {
            out.pulls.emplace_back(cellOf(p_map, 1 / options.alikeSize_m), Vec6(-w * r * J));
        }
        out.weight += robust;
        out.chi2 += w * r * r;
        out.square += robust * r * r;
        ++out.matched;
    }
    out.H = out.H.selfadjointView<Eigen::Lower>();
    return out;
}

/// The directions in which planes hold the scan, and what they say there. Rotations count as the
/// way they move a point at kLever_m, so that they compare with translations.
struct Held {
    Mat6 inverse = Mat6::Zero();  ///< of H, in held directions only
    Mat6 open = Mat6::Zero();     ///< covariance of the directions that are not held
};

/// A direction is held if H says clearly more of it than noise of the normals would.
Held heldBy(const System& s) {
    Vec6 scale;
    scale << Vec3::Ones(), Vec3::Constant(1 / kLever_m);
    const Mat6 S = scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Mat6> eigen(S * s.H * S);
    const Mat6 noise = S * s.noise * S;
    Held out;
    for (int i = 0; i < 6; ++i) {
        const Vec6 v = eigen.eigenvectors().col(i);
        const double information = eigen.eigenvalues()[i];
        const bool held = information > kClearly * v.dot(noise * v) && information > kNothing;
        const Vec6 x = S * v;
        (held ? out.inverse : out.open) += 1 / (held ? information : kNothing) * x * x.transpose();
    }
    return out;
}

/// What the points scatter says, and how much the blocks of neighbours disagree: H^-1 (sum of b b^T
/// over blocks) H^-1, the estimator of clustered errors ("sandwich").
Mat6 covarianceOf(System& s) {
    const Held held = heldBy(s);
    std::stable_sort(s.pulls.begin(), s.pulls.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Mat6 blocks = Mat6::Zero();
    for (std::size_t i = 0; i < s.pulls.size();) {
        const uint64_t block = s.pulls[i].first;
        Vec6 b = Vec6::Zero();
        for (; i < s.pulls.size() && s.pulls[i].first == block; ++i) b += s.pulls[i].second;
        blocks += b * b.transpose();
    }
    const Mat6 out = std::max(s.chi2 / s.weight, kLeastScatter) * held.inverse +
                     held.inverse * blocks * held.inverse + held.open;
    return 0.5 * (out + out.transpose());
}

}  // namespace

std::optional<Alignment> align(const std::vector<Vec3>& points, PlaneMap& map,
                               const SE3& T_map_vehicle_predicted, double kernel_m,
                               const ScanOptions& options) {
    const double enough = std::max(double(options.minMatched),
                                   options.minMatchedRatio * static_cast<double>(points.size()));
    SE3 T = T_map_vehicle_predicted;
    for (unsigned i = 0; i < options.iterations; ++i) {
        const System s = linearise(points, map, T, kernel_m, options);
        if (static_cast<double>(s.matched) < enough) return std::nullopt;
        const Vec6 step = heldBy(s).inverse * s.b;
        if (!step.allFinite()) return std::nullopt;
        T = (T * SE3::exp(step)).normalised();
        if (step.head<3>().norm() < kStep_m && step.tail<3>().norm() < kStep_rad) break;
    }
    System s = linearise(points, map, T, kernel_m, options, true);
    if (static_cast<double>(s.matched) < enough || !(s.weight > 0)) return std::nullopt;
    Alignment out;
    out.T_map_vehicle = T;
    out.covariance = covarianceOf(s);
    out.matched = s.matched;
    out.rms_m = std::sqrt(s.square / s.weight);
    return out;
}

}  // namespace djpete::scans
