/// Rigid motions: the true SE(3) exponential, logarithm, adjoint and Jacobians.
///
/// Law of the project: a twist is (rho, phi), translation part first, and a pose variable T_a_b is
/// perturbed on the RIGHT, in its own frame b: T <- T * exp(delta). (The paper perturbs on the
/// left; J_right = J_left * Ad(T).) MRPT's Lie::SE<3> logarithm is a pseudo-logarithm and is not
/// used.
#pragma once

#include "djpete/geometry/types.h"

namespace djpete::geometry {

/// A rigid motion T_a_b: maps coordinates of frame b to frame a, p_a = R * p_b + t.
class SE3 {
  public:
    SE3() : rotation_(Mat3::Identity()), translation_(Vec3::Zero()) {}
    /// `rotation` must be orthonormal with determinant +1 (not checked; see normalised()).
    SE3(const Mat3& rotation, const Vec3& translation)
        : rotation_(rotation), translation_(translation) {}

    /// True exponential of the twist xi = (rho, phi), phi in radians.
    static SE3 exp(const Vec6& xi);
    /// Rotation by `angle_rad` about the z axis followed by the translation.
    static SE3 fromYaw(double angle_rad, const Vec3& translation);

    const Mat3& rotation() const { return rotation_; }
    const Vec3& translation() const { return translation_; }
    Vec3& translation() { return translation_; }

    SE3 operator*(const SE3& other) const {
        return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
    }
    Vec3 operator*(const Vec3& point) const { return rotation_ * point + translation_; }
    SE3 inverse() const { return {rotation_.transpose(), -(rotation_.transpose() * translation_)}; }
    /// True logarithm (rho, phi), |phi| <= pi; exact to rounding also near 0 and near pi.
    Vec6 log() const;
    /// Ad(T): T exp(xi) = exp(Ad(T) xi) T, for twists (rho, phi).
    Mat6 adjoint() const;
    /// The same motion with its rotation put back on SO(3) (for long products).
    SE3 normalised() const;
    /// Angle of the rotation, in [0, pi].
    double angle_rad() const;
    /// Heading of the x axis in the parent's x-y plane, in (-pi, pi].
    double yaw_rad() const;
    Eigen::Matrix4d matrix() const;

  private:
    Mat3 rotation_;
    Vec3 translation_;
};

/// [v]x with [v]x w = v x w.
Mat3 skew(const Vec3& v);
/// Rotation vector of R, |phi| <= pi; exact to rounding also near pi.
Vec3 so3Log(const Mat3& R);
Mat3 so3Exp(const Vec3& phi);
/// Left Jacobian of SO(3), also the V of exp: t = V(phi) rho.
Mat3 so3LeftJacobian(const Vec3& phi);
Mat3 so3LeftJacobianInverse(const Vec3& phi);
/// Right Jacobian of SE(3): exp(xi + d) = exp(xi) exp(Jr(xi) d), closed form (Barfoot, State
/// Estimation for Robotics, eqs. 8.83-8.91, re-ordered to (rho, phi)).
Mat6 se3RightJacobian(const Vec6& xi);
/// Jr^-1: log(T exp(d)) = log(T) + Jr^-1(log T) d, closed form.
Mat6 se3RightJacobianInverse(const Vec6& xi);

/// Angle wrapped to (-pi, pi].
double wrapAngle(double angle_rad);

}  // namespace djpete::geometry
