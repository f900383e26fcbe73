/// Objects placed by their LiDAR points, after their detections have placed them roughly.
#pragma once

#include "djpete/backend/motion_chain.h"
#include "djpete/backend/objects.h"

namespace djpete::backend {

/// A standing object: one box for the points of all its views. Betters `out`, which must be solved;
/// leaves it as it is if there are too few points.
void refineStanding(const ObjectProblem::Object& in, const ObjectOptions& options,
                    ObjectUpdate::Object& out);

/// A moving object: `nodes` (one per edge, already smoothed) get the poses that the points of each
/// view give as measurements and are smoothed again; then one box for the points of all views,
/// fixed to the object, shifts them and sets `size_m`. Without points nothing changes.
void refineMoving(const std::vector<const ObjectProblem::Edge*>& edges,
                  const ObjectOptions& options, const MotionPrior& motion,
                  const ChainOptions& chain, std::vector<ChainNode>& nodes, geometry::Vec3& size_m);

}  // namespace djpete::backend
