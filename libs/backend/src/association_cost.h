/// What it costs to give a detection to a thing.
#pragma once

#include <vector>

#include "djpete/backend/association.h"
#include "djpete/obs/overlap.h"

namespace djpete::backend {

/// A detection, placed in the world.
struct Seen {
    map::ObjectObservation observation;
    geometry::SE3 T_world_obj;
    PositionYaw z;
    obs::UprightBox box;
};
std::vector<Seen> prepare(const ObjectAssociator::Frame& frame,
                          std::vector<map::ObjectObservation> detections,
                          const AssociationOptions& options);

/// True if `yaw_rad` points more backward than forward along `heading_rad`.
bool opposite(double yaw_rad, double heading_rad);

struct MatchCost {
    double cost = 0;        ///< for the assignment
    double logDensity = 0;  ///< ln of the probability density of the detection's position and yaw
                            ///< (modulo pi), if it is the thing's; per m^3 rad
};
/// Nothing outside the gates.
std::optional<MatchCost> matchCost(const TrackedThing& thing, const Seen& seen,
                                   const AssociationOptions& options);

/// Pairs (thing, detection) for the assignment.
struct Candidate {
    std::size_t thing, detection;
    MatchCost match;
};
/// The best one-to-one choice among `candidates` (sorted by thing), where leaving a thing alone
/// costs `unassignedCost`: one assignment per connected group, so that many far apart things cost
/// little. Index of the chosen candidate for each thing.
std::vector<std::optional<std::size_t>> choose(const std::vector<Candidate>& candidates,
                                               std::size_t things, std::size_t detections,
                                               double unassignedCost);

}  // namespace djpete::backend
