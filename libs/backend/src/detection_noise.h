/// What a detection's own covariance leaves out.
#pragma once

#include <vector>

#include "djpete/backend/association.h"

namespace djpete::backend {

/// Widens the covariances of one frame's detections: along the line of sight by
/// rangeSigma * range (1-sigma), and all over by 1 + occlusionNoise * covered / (1 - covered),
/// where `covered` is the share of its image box behind boxes of nearer detections.
void widen(std::vector<map::ObjectObservation>& detections, const AssociationOptions& options);

}  // namespace djpete::backend
