/// What is left of the rectification's error: where a point of the left image lies in the right
/// one, beside its row and its disparity.
#pragma once

#include <Eigen/Core>

#include "djpete/geometry/camera.h"

namespace djpete::frontend {

/// Terms of a smooth field over the left image, in x = (u - cx) / fx, y = (v - cy) / fy: 1, x, y,
/// xy, xx, yy. The first say pitch, roll and zoom of one camera against the other, xy its yaw and
/// what lenses do alike.
using RowTerms = Eigen::Matrix<double, 6, 1>;

inline RowTerms rowTerms(const geometry::Vec3& ray) {
    const double x = ray.x(), y = ray.y();
    RowTerms out;
    out << 1, x, y, x * y, x * x, y * y;
    return out;
}

struct StereoCalibration {
    RowTerms row_px = RowTerms::Zero();  ///< row right less row left
    double disparity_px = 0;             ///< measured less true: yaw, or a shifted image centre

    double rowAt(const geometry::Vec3& ray) const { return row_px.dot(rowTerms(ray)); }
};

}  // namespace djpete::frontend
