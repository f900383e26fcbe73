#include "djpete/evaluation/alignment.h"

#include <Eigen/SVD>

namespace djpete::evaluation {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;

namespace {

/// First and second moments of the paired positions.
struct Moments {
    Vec3 meanEstimate = Vec3::Zero(), meanTruth = Vec3::Zero();
    double varianceEstimate = 0, varianceTruth = 0;
    Mat3 covariance = Mat3::Zero();  ///< of truth (rows) and estimate (columns)
};

Moments momentsOf(const Trajectory& estimate, const Trajectory& truth) {
    const double n = static_cast<double>(estimate.size());
    Moments m;
    for (std::size_t i = 0; i < estimate.size(); ++i) {
        m.meanEstimate += estimate[i].translation() / n;
        m.meanTruth += truth[i].translation() / n;
    }
    for (std::size_t i = 0; i < estimate.size(); ++i) {
        const Vec3 x = estimate[i].translation() - m.meanEstimate;
        const Vec3 y = truth[i].translation() - m.meanTruth;
        m.varianceEstimate += x.squaredNorm() / n;
        m.varianceTruth += y.squaredNorm() / n;
        m.covariance += y * x.transpose() / n;
    }
    return m;
}

/// The rotation R that maximises trace(R^T covariance).
Mat3 bestRotation(const Mat3& covariance) {
    const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 sign(1, 1, 1);
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

Alignment aligned(const Moments& m, double scale, const Mat3& R) {
    return {scale, SE3(R, m.meanTruth - scale * (R * m.meanEstimate))};
}

}  // namespace

Alignment alignSe3(const Trajectory& estimate, const Trajectory& truth) {
    const Moments m = momentsOf(estimate, truth);
    return aligned(m, 1, bestRotation(m.covariance));
}

std::optional<Alignment> alignSim3(const Trajectory& estimate, const Trajectory& truth) {
    const Moments m = momentsOf(estimate, truth);
    constexpr double kStandsStill_m2 = 1e-12;
    if (m.varianceEstimate < kStandsStill_m2 || m.varianceTruth < kStandsStill_m2) {
        return std::nullopt;
    }
    const Mat3 R = bestRotation(m.covariance);
    return aligned(m, (R.transpose() * m.covariance).trace() / m.varianceEstimate, R);
}

}  // namespace djpete::evaluation
