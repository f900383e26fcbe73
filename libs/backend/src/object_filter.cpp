#include "djpete/backend/object_filter.h"

#include <algorithm>
#include <cmath>

namespace djpete::backend {

namespace {

using geometry::Mat3;
using geometry::Mat6;
using geometry::Vec3;
using geometry::Vec6;

/// A model never loses all weight, so that it can come back; and old evidence fades.
constexpr double kSmallestLogWeight = -6;
constexpr double kMemory = 0.95;
constexpr double kLargestDistance2 = 40;
/// Acceleration upwards, as a share of that along the ground.
constexpr double kRise = 0.15;
/// Squared distance (3 degrees of freedom, 99.99 %) at which the standing model has lost its
/// object.
constexpr double kLost = 21;

double logDet(const Mat3& S) {
    const Eigen::LLT<Mat3> llt(S);
    return 2 * Mat3(llt.matrixL()).diagonal().array().log().sum();
}

}  // namespace

ObjectFilter::ObjectFilter(const PositionYaw& first, const FilterOptions& options)
    : static_(first.p_world),
      staticP_(first.covariance),
      yaw_rad_(first.yaw_rad),
      yawVariance_(first.yawVariance) {
    moving_.head<3>() = first.p_world;
    movingP_.setZero();
    movingP_.topLeftCorner<3, 3>() = first.covariance;
    const Mat3 R = geometry::so3Exp({0, 0, first.yaw_rad});
    const Vec3 sigma(options.speed_mps, options.crossSpeed_mps, 0.3 * options.crossSpeed_mps);
    movingP_.bottomRightCorner<3, 3>() = R * sigma.cwiseAbs2().asDiagonal() * R.transpose();
}

void ObjectFilter::predict(double dt_s, const FilterOptions& options) {
    if (dt_s <= 0) return;
    staticP_ += dt_s * options.staticWalk * options.staticWalk * Mat3::Identity();
    Mat6 F = Mat6::Identity();
    F.topRightCorner<3, 3>() = dt_s * Mat3::Identity();
    const double q = options.acceleration_mps2 * options.acceleration_mps2;
    const double dt2 = dt_s * dt_s;
    Mat6 Q = Mat6::Zero();
    Q.topLeftCorner<3, 3>() = 0.25 * q * dt2 * dt2 * Mat3::Identity();
    Q.topRightCorner<3, 3>() = 0.5 * q * dt2 * dt_s * Mat3::Identity();
    Q.bottomLeftCorner<3, 3>() = Q.topRightCorner<3, 3>();
    Q.bottomRightCorner<3, 3>() = q * dt2 * Mat3::Identity();
    // Roads rise slowly.
    Q.row(2) *= kRise;
    Q.col(2) *= kRise;
    Q.row(5) *= kRise;
    Q.col(5) *= kRise;
    moving_ = F * moving_;
    movingP_ = F * movingP_ * F.transpose() + Q;
    yawVariance_ += dt_s * options.yawWalk * options.yawWalk;
}

ObjectFilter::Match ObjectFilter::match(const PositionYaw& z) const {
    const auto to = [&z](const Vec3& p, const Mat3& P, double logWeight) {
        const Mat3 S = P + z.covariance;
        const Vec3 d = z.p_world - p;
        return Match{d.dot(S.llt().solve(d)), logDet(S), logWeight, p};
    };
    const auto score = [](const Match& m) {
        return m.distance2 + m.logDeterminant - 2 * m.logWeight;
    };
    const Match standing = to(static_, staticP_, logStatic_);
    const Match moving = to(moving_.head<3>(), movingP_.topLeftCorner<3, 3>(), logMoving_);
    return score(standing) <= score(moving) ? standing : moving;
}

void ObjectFilter::update(const PositionYaw& z, const FilterOptions&) {
    const Mat3 staticS = staticP_ + z.covariance;
    const Mat3 movingS = movingP_.topLeftCorner<3, 3>() + z.covariance;
    const Vec3 staticError = z.p_world - static_, movingError = z.p_world - moving_.head<3>();
    const double staticD2 = staticError.dot(staticS.llt().solve(staticError));
    const double movingD2 = movingError.dot(movingS.llt().solve(movingError));
    logStatic_ =
        kMemory * logStatic_ - 0.5 * (std::min(staticD2, kLargestDistance2) + logDet(staticS));
    logMoving_ =
        kMemory * logMoving_ - 0.5 * (std::min(movingD2, kLargestDistance2) + logDet(movingS));
    const double best = std::max(logStatic_, logMoving_);
    logStatic_ = std::max(logStatic_ - best, kSmallestLogWeight);
    logMoving_ = std::max(logMoving_ - best, kSmallestLogWeight);

    if (staticD2 > kLost) {
        static_ = z.p_world;
        staticP_ = z.covariance;
    } else {
        const Mat3 K = staticP_ * staticS.inverse();
        static_ += K * staticError;
        staticP_ = (Mat3::Identity() - K) * staticP_;
        staticP_ = 0.5 * (staticP_ + staticP_.transpose()).eval();
    }
    const Eigen::Matrix<double, 6, 3> K = movingP_.leftCols<3>() * movingS.inverse();
    moving_ += K * movingError;
    movingP_ -= K * movingP_.topRows<3>().eval();
    movingP_ = 0.5 * (movingP_ + movingP_.transpose()).eval();

    const double k = yawVariance_ / (yawVariance_ + z.yawVariance);
    yaw_rad_ = geometry::wrapAngle(yaw_rad_ + k * geometry::wrapAngle(z.yaw_rad - yaw_rad_));
    yawVariance_ *= 1 - k;
}

void ObjectFilter::transform(const geometry::SE3& T_new_old) {
    const Mat3& R = T_new_old.rotation();
    static_ = T_new_old * static_;
    staticP_ = R * staticP_ * R.transpose();
    Mat6 RR = Mat6::Zero();
    RR.topLeftCorner<3, 3>() = R;
    RR.bottomRightCorner<3, 3>() = R;
    const Vec3 p = moving_.head<3>(), v = moving_.tail<3>();
    moving_ << T_new_old * p, R * v;
    movingP_ = RR * movingP_ * RR.transpose();
    yaw_rad_ = geometry::wrapAngle(yaw_rad_ + T_new_old.yaw_rad());
}

void ObjectFilter::turnRound() { yaw_rad_ = geometry::wrapAngle(yaw_rad_ + M_PI); }

geometry::Vec3 ObjectFilter::p_world() const {
    return likelyStatic() ? static_ : Vec3(moving_.head<3>());
}

}  // namespace djpete::backend
