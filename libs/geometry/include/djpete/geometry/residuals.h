/// All residuals: small value types of static dimension with analytic Jacobians.
///
/// A residual r is called with its variables and one optional Jacobian per variable:
///     r(T_world_cam, p_world, &J_cam, &J_point)        (nullptr = not wanted)
/// It returns the WHITENED error, |r|^2 = e^T I e, as a vector of kDim entries, or std::nullopt
/// where the error is not defined (a point behind the camera); the Jacobians are then left
/// untouched. Poses are perturbed on the right, T <- T exp(d); vectors and points are added to.
#pragma once

#include "djpete/geometry/information.h"
#include "djpete/geometry/point_residuals.h"
#include "djpete/geometry/pose_residuals.h"
#include "djpete/geometry/vector_residuals.h"
