/// Objects placed by their LiDAR points, after their detections have placed them roughly.
#pragma once

#include "djpete/backend/objects.h"

namespace djpete::backend {

/// A standing object: one box for the points of all its views. Betters `out`, which must be solved;
/// leaves it as it is if there are too few points.
void refineStanding(const ObjectProblem::Object& in, const ObjectOptions& options,
                    ObjectUpdate::Object& out);

/// A moving object: `edges` with the poses that their points give, each near the state that `out`
/// has for it (one state per edge, in the same order). Edges without points stay as they are.
std::vector<ObjectProblem::Edge> refineEdges(const std::vector<const ObjectProblem::Edge*>& edges,
                                             const ObjectUpdate::Object& out);

/// A moving object, solved with refined edges: one box for the points of all its views, fixed to
/// the object. Betters size and states of `out`.
void refineMovingBox(const std::vector<const ObjectProblem::Edge*>& edges,
                     const ObjectOptions& options, ObjectUpdate::Object& out);

}  // namespace djpete::backend
