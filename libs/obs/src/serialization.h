/// Small helpers shared by the observation classes of this room.
#pragma once

#include <mrpt/serialization/CArchive.h>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"

namespace djpete::obs {

/// Coefficients row by row, doubles.
template <class Derived>
void writeMatrix(mrpt::serialization::CArchive& out, const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index r = 0; r < m.rows(); ++r) {
        for (Eigen::Index c = 0; c < m.cols(); ++c) out << m(r, c);
    }
}

template <class Derived>
void readMatrix(mrpt::serialization::CArchive& in, Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index r = 0; r < m.rows(); ++r) {
        for (Eigen::Index c = 0; c < m.cols(); ++c) in >> m(r, c);
    }
}

inline void writePose(mrpt::serialization::CArchive& out, const geometry::SE3& T) {
    writeMatrix(out, T.rotation());
    writeMatrix(out, T.translation());
}

inline geometry::SE3 readPose(mrpt::serialization::CArchive& in) {
    geometry::Mat3 R;
    geometry::Vec3 t;
    readMatrix(in, R);
    readMatrix(in, t);
    return {R, t};
}

inline void writeCamera(mrpt::serialization::CArchive& out, const geometry::StereoCamera& c) {
    out << c.fx << c.fy << c.cx << c.cy << c.baseline_m << static_cast<int32_t>(c.width_px)
        << static_cast<int32_t>(c.height_px);
}

inline geometry::StereoCamera readCamera(mrpt::serialization::CArchive& in) {
    geometry::StereoCamera c;
    int32_t w = 0, h = 0;
    in >> c.fx >> c.fy >> c.cx >> c.cy >> c.baseline_m >> w >> h;
    c.width_px = w;
    c.height_px = h;
    return c;
}

}  // namespace djpete::obs
