#include "djpete/backend/standing_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;
using Measured = ChainNode::Measured;

/// Measured poses tried as the start, and those that judge them.
constexpr std::size_t kStarts = 12, kVoters = 24;
/// Graduated non-convexity: the kernel starts this much wider and narrows by kNarrow.
constexpr double kWiden = 8, kNarrow = 2;
constexpr int kSteps = 3, kLastSteps = 12;
constexpr double kSmallStep = 1e-5;

double cost(const std::vector<Measured>& measured, const SE3& T_world_obj,
            const solver::RobustKernel& kernel, std::size_t stride) {
    double sum = 0;
    for (std::size_t i = 0; i < measured.size(); i += stride) {
        const Vec6 e = (measured[i].T_world_obj.inverse() * T_world_obj).log();
        const double s = e.dot(measured[i].information * e);
        sum += measured[i].robust ? kernel.rho(s) : s;
    }
    return 0.5 * sum;
}

SE3 mostAgreed(const std::vector<Measured>& measured, double scale) {
    const auto kernel = solver::RobustKernel::gemanMcClure(scale);
    const std::size_t stride = (measured.size() + kVoters - 1) / kVoters;
    const std::size_t step = (measured.size() + kStarts - 1) / kStarts;
    double least = std::numeric_limits<double>::infinity();
    SE3 best = measured.back().T_world_obj;
    for (std::size_t i = 0; i < measured.size(); i += step) {
        const double c = cost(measured, measured[i].T_world_obj, kernel, stride);
        if (c < least) {
            least = c;
            best = measured[i].T_world_obj;
        }
    }
    return best;
}

struct Normal {
    Mat6 H = Mat6::Zero();
    Vec6 g = Vec6::Zero();
};

/// Tilt of the z axis against up: R' up = (y, -x) of the small rotation back.
void addUpright(const UprightPrior& prior, const SE3& T_world_obj, Normal& n) {
    const Vec3 up_obj = T_world_obj.rotation().transpose() * prior.up_world;
    const double information = 1 / (prior.sigma_rad * prior.sigma_rad);
    // exp(delta)' up = up + [up]x delta; the x and y of it shall be zero.
    Eigen::Matrix<double, 2, 3> J = geometry::skew(up_obj).topRows<2>();
    n.H.bottomRightCorner<3, 3>() += information * J.transpose() * J;
    n.g.tail<3>() += information * J.transpose() * up_obj.head<2>();
}

Normal linearise(const std::vector<Measured>& measured, const SE3& T_world_obj,
                 const solver::RobustKernel& kernel, const std::optional<UprightPrior>& upright) {
    Normal n;
    for (const auto& m : measured) {
        const Vec6 e = (m.T_world_obj.inverse() * T_world_obj).log();
        const double s = e.dot(m.information * e);
        const Mat6 J = geometry::se3RightJacobianInverse(e);
        const Mat6 WJ = (m.robust ? kernel.weight(s) : 1.0) * (m.information * J);
        n.H.noalias() += J.transpose() * WJ;
        n.g.noalias() += WJ.transpose() * e;
    }
    if (upright) addUpright(*upright, T_world_obj, n);
    return n;
}

}  // namespace

std::optional<StandingFit> fitStanding(const std::vector<Measured>& measured,
                                       const solver::RobustKernel& kernel,
                                       const std::optional<UprightPrior>& upright,
                                       const std::optional<SE3>& start) {
    if (measured.empty()) return std::nullopt;
    StandingFit out;
    out.T_world_obj = start ? *start : mostAgreed(measured, kernel.scale);
    auto wide = kernel;
    const bool robust = kernel.type != solver::RobustKernel::Type::None;
    if (!start && robust) wide.scale *= kWiden;
    for (;;) {
        const bool last = wide.scale <= kernel.scale;
        for (int i = 0; i < (last ? kLastSteps : kSteps); ++i) {
            const Normal n = linearise(measured, out.T_world_obj, wide, upright);
            const Eigen::LLT<Mat6> llt(n.H);
            if (llt.info() != Eigen::Success) return std::nullopt;
            const Vec6 step = -llt.solve(n.g);
            out.T_world_obj = (out.T_world_obj * SE3::exp(step)).normalised();
            if (step.norm() < kSmallStep) break;
        }
        if (last) break;
        wide.scale = std::max(kernel.scale, wide.scale / kNarrow);
    }
    if (!out.T_world_obj.matrix().allFinite()) return std::nullopt;
    const Normal n = linearise(measured, out.T_world_obj, kernel, upright);
    const Eigen::LLT<Mat6> llt(n.H);
    if (llt.info() != Eigen::Success) return std::nullopt;
    out.covariance = llt.solve(Mat6::Identity());
    out.cost = cost(measured, out.T_world_obj, kernel, 1);
    return out;
}

}  // namespace djpete::backend
