/// Which corners of two views look alike.
#pragma once

#include <vector>

#include "pair_geometry.h"

namespace djpete::places {

/// Pairs that are each other's nearest, near enough and clearly nearer than the second.
std::vector<CornerPair> pairsByLooks(const ViewPair& views);

/// The same among pairs that T_a_b brings within `radius_px` of each other. A pair needs a point
/// in at least one view.
std::vector<CornerPair> pairsNear(const ViewPair& views, const geometry::SE3& T_a_b,
                                  double radius_px);

}  // namespace djpete::places
