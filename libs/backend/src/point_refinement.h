/// Objects placed by their LiDAR points, after their detections have placed them roughly.
#pragma once

#include "djpete/backend/objects.h"

namespace djpete::backend {

/// A standing object: one box for the points of all its views. Betters `out`, which must be solved;
/// leaves it as it is if there are too few points.
void refineStanding(const ObjectProblem::Object& in, const ObjectOptions& options,
                    ObjectUpdate::Object& out);

}  // namespace djpete::backend
