/// Central differences for SE3 (right perturbation) and vector variables.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "djpete/geometry/se3.h"

namespace djpete_test {

using djpete::geometry::SE3;

/// d f(T exp(d)) / d d at d = 0.
template <int N>
Eigen::Matrix<double, N, 6> numericJacobian(
    const std::function<Eigen::Matrix<double, N, 1>(const SE3&)>& f, const SE3& T,
    double step = 1e-6) {
    Eigen::Matrix<double, N, 6> J;
    for (int i = 0; i < 6; ++i) {
        Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
        d[i] = step;
        J.col(i) = (f(T * SE3::exp(d)) - f(T * SE3::exp(-d))) / (2 * step);
    }
    return J;
}

/// d f(x) / d x.
template <int N, int M>
Eigen::Matrix<double, N, M> numericJacobian(
    const std::function<Eigen::Matrix<double, N, 1>(const Eigen::Matrix<double, M, 1>&)>& f,
    const Eigen::Matrix<double, M, 1>& x, double step = 1e-6) {
    Eigen::Matrix<double, N, M> J;
    for (int i = 0; i < M; ++i) {
        Eigen::Matrix<double, M, 1> d = Eigen::Matrix<double, M, 1>::Zero();
        d[i] = step;
        J.col(i) = (f(x + d) - f(x - d)) / (2 * step);
    }
    return J;
}

}  // namespace djpete_test
