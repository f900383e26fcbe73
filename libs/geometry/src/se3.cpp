#include "djpete/geometry/se3.h"

#include <cmath>

namespace djpete::geometry {

namespace {

/// Below this angle the closed forms are replaced by their series (next term ~ angle^4 / 5000).
constexpr double kSmallAngle = 1e-3;

/// The coefficients of exp and its Jacobians as functions of the angle.
struct Coefficients {
    double a;  ///< sin(t)/t
    double b;  ///< (1-cos t)/t^2
    double c;  ///< (t-sin t)/t^3
};

Coefficients coefficients(double t) {
    const double t2 = t * t;
    if (t < kSmallAngle) {
        return {1 - t2 / 6 + t2 * t2 / 120, 0.5 - t2 / 24 + t2 * t2 / 720,
                1.0 / 6 - t2 / 120 + t2 * t2 / 5040};
    }
    const double half = std::sin(0.5 * t);
    return {std::sin(t) / t, 2 * half * half / t2, (t - std::sin(t)) / (t2 * t)};
}

/// The coupling block Q of the SE(3) left Jacobian, with rho and phi as in Barfoot (8.91).
Mat3 leftJacobianCoupling(const Vec3& rho, const Vec3& phi) {
    const double t = phi.norm();
    const double t2 = t * t;
    const Mat3 P = skew(phi);
    const Mat3 R = skew(rho);
    double c1, c2, c3;
    // The closed forms of c2, c3 cancel like eps/t^4, eps/t^5, so the series reaches further here.
    if (t < 0.1) {
        const double t4 = t2 * t2;
        const double t6 = t4 * t2;
        c1 = 1.0 / 6 - t2 / 120 + t4 / 5040 - t6 / 362880;
        c2 = 1.0 / 24 - t2 / 720 + t4 / 40320 - t6 / 3628800;
        c3 = 1.0 / 120 - t2 / 2520 + t4 / 120960 - t6 / 9979200;
    } else {
        const double s = std::sin(t);
        const double c = std::cos(t);
        c1 = (t - s) / (t2 * t);
        c2 = (t2 + 2 * c - 2) / (2 * t2 * t2);
        c3 = (2 * t - 3 * s + t * c) / (2 * t2 * t2 * t);
    }
    const Mat3 PR = P * R;
    const Mat3 RP = R * P;
    const Mat3 PRP = PR * P;
    return 0.5 * R + c1 * (PR + RP + PRP) + c2 * (P * PR + RP * P - 3 * PRP) +
           c3 * (PRP * P + P * PRP);
}

}  // namespace

Mat3 skew(const Vec3& v) {
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

Mat3 so3Exp(const Vec3& phi) {
    const Coefficients k = coefficients(phi.norm());
    const Mat3 W = skew(phi);
    return Mat3::Identity() + k.a * W + k.b * W * W;
}

Vec3 so3Log(const Mat3& R) {
    // The quaternion route keeps full precision near pi, where the trace formula loses it.
    Eigen::Quaterniond q(R);
    q.normalize();
    Vec3 v = q.vec();
    double w = q.w();
    if (w < 0) {
        v = -v;
        w = -w;
    }
    const double n = v.norm();
    if (n < 1e-9) return (2.0 / w) * v;
    return (2.0 * std::atan2(n, w) / n) * v;
}

Mat3 so3LeftJacobian(const Vec3& phi) {
    const Coefficients k = coefficients(phi.norm());
    const Mat3 W = skew(phi);
    return Mat3::Identity() + k.b * W + k.c * W * W;
}

Mat3 so3LeftJacobianInverse(const Vec3& phi) {
    const double t = phi.norm();
    const Mat3 W = skew(phi);
    double d;  // (1 - (t/2) cot(t/2)) / t^2
    if (t < 1e-2) {
        const double t2 = t * t;
        d = 1.0 / 12 + t2 / 720 + t2 * t2 / 30240;
    } else {
        const double half = 0.5 * t;
        d = (1 - half * std::cos(half) / std::sin(half)) / (t * t);
    }
    return Mat3::Identity() - 0.5 * W + d * W * W;
}

Mat6 se3RightJacobian(const Vec6& xi) {
    // Jr(xi) = Jl(-xi)
    const Vec3 rho = -xi.head<3>();
    const Vec3 phi = -xi.tail<3>();
    const Mat3 J = so3LeftJacobian(phi);
    Mat6 out = Mat6::Zero();
    out.topLeftCorner<3, 3>() = J;
    out.bottomRightCorner<3, 3>() = J;
    out.topRightCorner<3, 3>() = leftJacobianCoupling(rho, phi);
    return out;
}

Mat6 se3RightJacobianInverse(const Vec6& xi) {
    const Vec3 rho = -xi.head<3>();
    const Vec3 phi = -xi.tail<3>();
    const Mat3 Jinv = so3LeftJacobianInverse(phi);
    Mat6 out = Mat6::Zero();
    out.topLeftCorner<3, 3>() = Jinv;
    out.bottomRightCorner<3, 3>() = Jinv;
    out.topRightCorner<3, 3>() = -Jinv * leftJacobianCoupling(rho, phi) * Jinv;
    return out;
}

SE3 SE3::exp(const Vec6& xi) {
    const Vec3 phi = xi.tail<3>();
    return {so3Exp(phi), so3LeftJacobian(phi) * xi.head<3>()};
}

SE3 SE3::fromYaw(double angle_rad, const Vec3& translation) {
    return {Eigen::AngleAxisd(angle_rad, Vec3::UnitZ()).toRotationMatrix(), translation};
}

Vec6 SE3::log() const {
    const Vec3 phi = so3Log(rotation_);
    Vec6 xi;
    xi << so3LeftJacobianInverse(phi) * translation_, phi;
    return xi;
}

Mat6 SE3::adjoint() const {
    Mat6 A = Mat6::Zero();
    A.topLeftCorner<3, 3>() = rotation_;
    A.bottomRightCorner<3, 3>() = rotation_;
    A.topRightCorner<3, 3>() = skew(translation_) * rotation_;
    return A;
}

SE3 SE3::normalised() const {
    return {Eigen::Quaterniond(rotation_).normalized().toRotationMatrix(), translation_};
}

double SE3::angle_rad() const { return so3Log(rotation_).norm(); }

double SE3::yaw_rad() const { return std::atan2(rotation_(1, 0), rotation_(0, 0)); }

Eigen::Matrix4d SE3::matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = rotation_;
    m.topRightCorner<3, 1>() = translation_;
    return m;
}

double wrapAngle(double angle_rad) {
    const double w = std::remainder(angle_rad, 2 * M_PI);
    return w <= -M_PI ? w + 2 * M_PI : w;
}

}  // namespace djpete::geometry
