/// Least-squares alignment of two paths.
#pragma once

#include <optional>

#include "djpete/evaluation/trajectory.h"

namespace djpete::evaluation {

/// p_truth = scale * T.rotation() * p_estimate + T.translation().
struct Alignment {
    double scale = 1;
    geometry::SE3 T_truth_estimate;

    geometry::Vec3 operator*(const geometry::Vec3& p_estimate) const {
        return scale * (T_truth_estimate.rotation() * p_estimate) + T_truth_estimate.translation();
    }
};

/// The rigid motion that minimises the squared distances between the positions of both paths
/// (Umeyama, "Least-squares estimation of transformation parameters between two point patterns",
/// PAMI 1991). Paths must be of equal length and not empty. Where positions leave a rotation open
/// (all on a line), one of the best is returned.
Alignment alignSe3(const Trajectory& estimate, const Trajectory& truth);

/// The same with a free scale; nothing if all positions of one path coincide (the scale would be
/// 0 or arbitrary).
std::optional<Alignment> alignSim3(const Trajectory& estimate, const Trajectory& truth);

}  // namespace djpete::evaluation
