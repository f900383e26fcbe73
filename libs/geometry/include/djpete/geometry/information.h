/// Whitening: how a residual gets the weight of its information matrix.
#pragma once

#include <optional>

#include "djpete/geometry/types.h"

namespace djpete::geometry {

/// W with |W e|^2 = e^T I e for a symmetric, positive semi-definite information matrix I (the
/// inverse covariance; zero eigenvalues mean "says nothing here"). Nothing if I has a non-finite
/// entry, is not symmetric (to 1e-6 of its largest entry), or has an eigenvalue below -1e-9 of that
/// entry.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> sqrtInformation(
    const Eigen::Matrix<double, N, N>& information) {
    using Mat = Eigen::Matrix<double, N, N>;
    if (!information.allFinite()) return std::nullopt;
    const double scale = information.cwiseAbs().maxCoeff();
    if ((information - information.transpose()).cwiseAbs().maxCoeff() > 1e-6 * scale) {
        return std::nullopt;
    }
    const Mat symmetric = 0.5 * (information + information.transpose());
    const Eigen::LLT<Mat> llt(symmetric);
    if (llt.info() == Eigen::Success) return Mat(llt.matrixL().transpose());
    const Eigen::SelfAdjointEigenSolver<Mat> eigen(symmetric);
    if (eigen.info() != Eigen::Success || eigen.eigenvalues().minCoeff() < -1e-9 * scale) {
        return std::nullopt;
    }
    return Mat(eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
               eigen.eigenvectors().transpose());
}

}  // namespace djpete::geometry
