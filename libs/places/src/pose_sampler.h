/// The pose that most pairs support, from samples of three.
#pragma once

#include <optional>
#include <vector>

#include "pair_geometry.h"

namespace djpete::places {

struct SampledPose {
    geometry::SE3 T_a_b;
    std::size_t support = 0;  ///< pairs within a few pixels
};

/// P3P on points of a seen in b and on points of b seen in a, in turn; `guess` competes if given.
/// The same seed gives the same pose. Nothing with fewer than four usable pairs.
std::optional<SampledPose> samplePose(const ViewPair& views, const std::vector<CornerPair>& pairs,
                                      const std::optional<geometry::SE3>& guess_T_a_b,
                                      uint64_t seed);

}  // namespace djpete::places
