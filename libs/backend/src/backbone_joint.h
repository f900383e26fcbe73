/// The second stage of a backbone's solve: objects join what has been solved without them.
#pragma once

#include <vector>

#include "djpete/backend/joint.h"
#include "djpete/solver/problem.h"

namespace djpete::backend {

/// A residual of the backbone and the kernel it was added with.
struct BackboneEdge {
    solver::ResidualId id;
    solver::RobustKernel kernel;
};

/// Adds the objects of `in` to a solved `problem` and solves it once more. `points` are the edges
/// of in.observations, `others` all that is not of points. True if the result passes the gate of
/// `options`; if not, all variables are as before, bit by bit.
bool solveWithObjects(solver::Problem& problem, const BackboneProblem& in,
                      const std::vector<solver::PoseId>& poses,
                      const std::vector<solver::PointId>& pointIds,
                      const std::vector<BackboneEdge>& points,
                      const std::vector<BackboneEdge>& others, const JointOptions& options,
                      int iterations);

}  // namespace djpete::backend
