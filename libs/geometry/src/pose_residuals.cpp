#include "djpete/geometry/pose_residuals.h"

namespace djpete::geometry {

Vec6 RelativePoseResidual::operator()(const SE3& T_world_a, const SE3& T_world_b, Mat6* J_a,
                                      Mat6* J_b) const {
    const SE3 T_a_b = T_world_a.inverse() * T_world_b;
    const Vec6 e = (T_b_a_measured_ * T_a_b).log();
    if (J_a || J_b) {
        const Mat6 J = sqrt_information_ * se3RightJacobianInverse(e);
        if (J_b) *J_b = J;
        if (J_a) *J_a = -J * T_a_b.inverse().adjoint();
    }
    return sqrt_information_ * e;
}

Vec6 PosePriorResidual::operator()(const SE3& T, Mat6* J) const {
    const Vec6 e = (T_expected_inverse_ * T).log();
    if (J) *J = sqrt_information_ * se3RightJacobianInverse(e);
    return sqrt_information_ * e;
}

Vec6 ConstantVelocityResidual::operator()(const SE3& T_world_obj_k, const Vec6& twist,
                                          const SE3& T_world_obj_k1, Mat6* J_k, Mat6* J_twist,
                                          Mat6* J_k1) const {
    const Vec6 motion = dt_s_ * twist;
    const SE3 T_k_k1 = T_world_obj_k.inverse() * T_world_obj_k1;
    const SE3 error = SE3::exp(-motion) * T_k_k1;
    const Vec6 e = error.log();
    if (J_k || J_twist || J_k1) {
        const Mat6 J = sqrt_information_ * se3RightJacobianInverse(e);
        if (J_k1) *J_k1 = J;
        if (J_k) *J_k = -J * T_k_k1.inverse().adjoint();
        // exp(-(m + dm)) = exp(-Jr(m) dm) exp(-m), moved to the right of the error.
        if (J_twist) {
            *J_twist = -dt_s_ * J * error.inverse().adjoint() * se3RightJacobian(motion);
        }
    }
    return sqrt_information_ * e;
}

}  // namespace djpete::geometry
