#include "djpete/geometry/mrpt_bridge.h"

#include <mrpt/math/CMatrixFixed.h>

namespace djpete::geometry {

mrpt::poses::CPose3D toCPose3D(const SE3& T_a_b) {
    mrpt::math::CMatrixDouble44 m;
    m.asEigen() = T_a_b.matrix();
    return mrpt::poses::CPose3D(m);
}

SE3 fromCPose3D(const mrpt::poses::CPose3D& T_a_b) {
    Mat3 R = T_a_b.getRotationMatrix().asEigen();
    return {R, Vec3(T_a_b.x(), T_a_b.y(), T_a_b.z())};
}

SE3 opticalToVehicleAxes() {
    Mat3 R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return {R, Vec3::Zero()};
}

}  // namespace djpete::geometry
