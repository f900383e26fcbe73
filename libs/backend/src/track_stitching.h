/// Which lost object is which new one.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "djpete/backend/objects.h"

namespace djpete::backend {

struct Stitch {
    map::ObjectId earlier, later;
    double logOdds = 0;  ///< for being one, against the later one being new
};

/// Pairs of objects of which one was lost before the other was first seen and that a motion with
/// white noise on acceleration joins well, both ends' poses and twists taken into account. At least
/// one of the two moves. Each object is in one pair at most, the surest pairs first. Only pairs
/// with one of `changed`.
std::vector<Stitch> stitches(const map::SlamMap& map, const std::set<map::ObjectId>& changed,
                             const ObjectOptions& options);

}  // namespace djpete::backend
