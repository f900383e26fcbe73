/// The same problems for Ceres, by automatic differentiation: the judge of our solver.
#pragma once

#include <ceres/ceres.h>

#include <array>
#include <memory>
#include <vector>

#include "djpete_test/street_problem.h"

namespace djpete_test {

/// q (x, y, z, w) then t: Ceres' parameter block of a pose.
using CeresPose = std::array<double, 7>;

inline CeresPose toCeres(const SE3& T) {
    const Eigen::Quaterniond q(T.rotation());
    const Vec3& t = T.translation();
    return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

inline ceres::Manifold* ceresPoseManifold() {
    return new ceres::ProductManifold<ceres::EigenQuaternionManifold,
                                      ceres::EuclideanManifold<3>>();
}

/// (u_left, v, u_right) of the textbook, measured minus predicted.
struct CeresStereo {
    StereoCamera camera;
    Vec3 uvu;
    template <class T>
    bool operator()(const T* pose, const T* point, T* e) const {
        const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
        const Eigen::Map<const Eigen::Matrix<T, 3, 1>> t(pose + 4), p(point);
        const Eigen::Matrix<T, 3, 1> c = q.conjugate() * Eigen::Matrix<T, 3, 1>(p - t);
        e[0] = uvu.x() - (camera.fx * c.x() / c.z() + camera.cx);
        e[1] = uvu.y() - (camera.fy * c.y() / c.z() + camera.cy);
        e[2] = uvu.z() - (camera.fx * (c.x() - camera.baseline_m) / c.z() + camera.cx);
        return true;
    }
};

/// Owns what the Ceres problem points to.
struct CeresStreet {
    std::vector<CeresPose> cameras;
    std::vector<Vec3> points;
    std::unique_ptr<ceres::Problem> problem;
};

/// `loss` makes one Ceres loss per residual, or is nullptr.
inline CeresStreet ceresStereoProblem(const StreetWorld& world, const StartOptions& options,
                                      ceres::LossFunction* (*loss)() = nullptr) {
    const StreetStart start = disturbed(world, options);
    CeresStreet out;
    for (const SE3& T : start.T_world_cam) out.cameras.push_back(toCeres(T));
    out.points = start.p_world;
    out.problem = std::make_unique<ceres::Problem>();
    for (auto& camera : out.cameras) {
        out.problem->AddParameterBlock(camera.data(), 7, ceresPoseManifold());
    }
    for (int c = 0; c < options.fixedCameras; ++c) {
        out.problem->SetParameterBlockConstant(out.cameras[std::size_t(c)].data());
    }
    for (const StereoObservation& z : world.observations) {
        out.problem->AddResidualBlock(new ceres::AutoDiffCostFunction<CeresStereo, 3, 7, 3>(
                                          new CeresStereo{world.camera, z.uvu}),
                                      loss ? loss() : nullptr,
                                      out.cameras[std::size_t(z.camera)].data(),
                                      out.points[std::size_t(z.point)].data());
    }
    return out;
}

}  // namespace djpete_test
