#include <cmath>

#include "djpete/backend/objects.h"
#include "djpete/solver/robust_kernel.h"

namespace djpete::backend {

namespace {

using geometry::Mat3;
using geometry::Mat6;
using geometry::Vec3;
using geometry::Vec6;
using Edge = ObjectProblem::Edge;

constexpr int kReweightings = 4;
constexpr double kCauchyScale = 3;  // sigmas, 3 degrees of freedom
/// 1-sigma of what moves neighbouring detections together: odometry, bias of a view.
constexpr double kCommonSigma_m = 0.1;

struct Sample {
    double t_s;
    Vec3 p_world;
    Mat3 information;
};

std::vector<Sample> positions(const std::vector<Edge>& edges) {
    std::vector<Sample> out;
    for (const auto& e : edges) {
        const geometry::SE3 T_world_obj = e.T_world_cam * e.T_cam_obj;
        const Mat6 covariance = (e.information + 0.01 * Mat6::Identity()).inverse();
        const Mat3& R = T_world_obj.rotation();
        const Mat3 P = R * covariance.topLeftCorner<3, 3>() * R.transpose() +
                       kCommonSigma_m * kCommonSigma_m * Mat3::Identity();
        out.push_back({e.time_s, T_world_obj.translation(), P.inverse()});
    }
    return out;
}

/// p(t) = p0 + v (t - tMean), with v = 0 if `standing`, by re-weighted least squares.
struct Fit {
    Vec3 p0{0, 0, 0}, v{0, 0, 0};
    double cost = 0;  ///< sum of rho, twice the robust cost
};

Fit fit(const std::vector<Sample>& samples, double tMean_s, bool standing) {
    const auto kernel = solver::RobustKernel::cauchy(kCauchyScale);
    Fit out;
    std::vector<double> weights(samples.size(), 1.0);
    for (int round = 0; round < kReweightings; ++round) {
        Mat6 A = Mat6::Zero();
        Vec6 b = Vec6::Zero();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double t = samples[i].t_s - tMean_s;
            const Mat3 W = weights[i] * samples[i].information;
            A.topLeftCorner<3, 3>() += W;
            A.topRightCorner<3, 3>() += t * W;
            A.bottomRightCorner<3, 3>() += t * t * W;
            b.head<3>() += W * samples[i].p_world;
            b.tail<3>() += t * W * samples[i].p_world;
        }
        A.bottomLeftCorner<3, 3>() = A.topRightCorner<3, 3>();
        if (standing) {
            out.p0 = A.topLeftCorner<3, 3>().ldlt().solve(b.head<3>());
        } else {
            const Vec6 x = A.ldlt().solve(b);
            out.p0 = x.head<3>();
            out.v = x.tail<3>();
        }
        out.cost = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Vec3 d = samples[i].p_world - out.p0 - (samples[i].t_s - tMean_s) * out.v;
            const double s = d.dot(samples[i].information * d);
            weights[i] = kernel.weight(s);
            out.cost += kernel.rho(s);
        }
    }
    return out;
}

}  // namespace

MotionEvidence motionEvidence(const std::vector<Edge>& edges, const ObjectOptions&) {
    MotionEvidence out;
    if (edges.size() < 3) return out;
    const auto samples = positions(edges);
    double tMean_s = 0;
    for (const auto& s : samples) tMean_s += s.t_s / static_cast<double>(samples.size());
    const Fit standing = fit(samples, tMean_s, true);
    const Fit moving = fit(samples, tMean_s, false);
    out.chi2Drop = standing.cost - moving.cost;
    out.speed_mps = moving.v.norm();
    out.timeSpan_s = edges.back().time_s - edges.front().time_s;
    out.travel_m = out.speed_mps * out.timeSpan_s;
    return out;
}

}  // namespace djpete::backend
