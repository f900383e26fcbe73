/// Absolute trajectory error for tests: an independent few lines, not the evaluation room's.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete_test {

/// RMSE of positions after the best rigid alignment (SE(3), no scale), metres. Equal sizes >= 3.
inline double ateSe3_m(const std::vector<djpete::geometry::SE3>& estimate,
                       const std::vector<djpete::geometry::SE3>& truth) {
    if (estimate.size() != truth.size() || estimate.size() < 3)
        throw std::invalid_argument("ateSe3_m: expected two trajectories of one length >= 3");
    const auto n = static_cast<Eigen::Index>(estimate.size());
    Eigen::Matrix3Xd a(3, n), b(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
        a.col(i) = estimate[static_cast<std::size_t>(i)].translation();
        b.col(i) = truth[static_cast<std::size_t>(i)].translation();
    }
    const Eigen::Matrix4d T = Eigen::umeyama(a, b, false);
    const Eigen::Matrix3Xd aligned =
        (T.topLeftCorner<3, 3>() * a).colwise() + T.topRightCorner<3, 1>();
    return std::sqrt((aligned - b).squaredNorm() / static_cast<double>(n));
}

}  // namespace djpete_test
