/// Residuals between poses: camera-object edge, relative pose, prior, constant velocity.
///
/// All errors are true SE(3) logarithms, twists (rho, phi), whitened by W = sqrtInformation(I); I
/// speaks in the frame of the measured body.
#pragma once

#include "djpete/geometry/se3.h"

namespace djpete::geometry {

/// e = log(Z^-1 T_world_a^-1 T_world_b), Z = T_a_b as measured. Variables: T_world_a, T_world_b.
///     J_b = W Jr^-1(e),   J_a = -W Jr^-1(e) Ad((T_world_a^-1 T_world_b)^-1)
class RelativePoseResidual {
  public:
    static constexpr int kDim = 6;
    static constexpr const char* kName = "RelativePoseResidual";

    RelativePoseResidual(const SE3& T_a_b_measured, const Mat6& sqrt_information)
        : T_b_a_measured_(T_a_b_measured.inverse()), sqrt_information_(sqrt_information) {}

    Vec6 operator()(const SE3& T_world_a, const SE3& T_world_b, Mat6* J_a = nullptr,
                    Mat6* J_b = nullptr) const;

  private:
    SE3 T_b_a_measured_;
    Mat6 sqrt_information_;
};

/// Camera-object edge (paper, section 3.2.1): e = log(Z_cam_obj^-1 T_world_cam^-1 T_world_obj).
/// Variables: T_world_cam, T_world_obj.
class CameraObjectResidual : public RelativePoseResidual {
  public:
    static constexpr const char* kName = "CameraObjectResidual";
    CameraObjectResidual(const SE3& T_cam_obj_measured, const Mat6& sqrt_information)
        : RelativePoseResidual(T_cam_obj_measured, sqrt_information) {}
};

/// e = log(T_expected^-1 T), variable T.
class PosePriorResidual {
  public:
    static constexpr int kDim = 6;
    static constexpr const char* kName = "PosePriorResidual";

    PosePriorResidual(const SE3& T_expected, const Mat6& sqrt_information)
        : T_expected_inverse_(T_expected.inverse()), sqrt_information_(sqrt_information) {}

    Vec6 operator()(const SE3& T, Mat6* J = nullptr) const;

  private:
    SE3 T_expected_inverse_;
    Mat6 sqrt_information_;
};

/// An object keeps its body twist v (per second, in the object's frame) for dt seconds:
/// e = log((T_world_obj_k exp(v dt))^-1 T_world_obj_k1). Variables: T_world_obj_k, v,
/// T_world_obj_k1.
class ConstantVelocityResidual {
  public:
    static constexpr int kDim = 6;
    static constexpr const char* kName = "ConstantVelocityResidual";

    ConstantVelocityResidual(double dt_s, const Mat6& sqrt_information)
        : dt_s_(dt_s), sqrt_information_(sqrt_information) {}

    Vec6 operator()(const SE3& T_world_obj_k, const Vec6& twist, const SE3& T_world_obj_k1,
                    Mat6* J_k = nullptr, Mat6* J_twist = nullptr, Mat6* J_k1 = nullptr) const;

  private:
    double dt_s_;
    Mat6 sqrt_information_;
};

}  // namespace djpete::geometry
