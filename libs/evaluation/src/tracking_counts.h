/// One pass over a drive at one limit and score threshold. Private to the room.
#pragma once

#include <optional>
#include <vector>

#include "tracking_frames.h"

namespace djpete::evaluation {

struct TrackingPass {
    std::vector<bool> kept;                                 ///< per result: reaches the threshold
    std::vector<bool> matched;                              ///< per result
    std::vector<std::optional<std::size_t>> resultOfLabel;  ///< per label
    TrackingCounts counts;
};

/// Without `minScore` all results are kept.
TrackingPass passOver(const TrackingDrive& drive, double limit, std::optional<double> minScore);

/// What HOTA compares: without ignored labels, results matched to them and ignored results.
HotaSums hotaSums(const TrackingDrive& drive, const TrackingPass& pass);

}  // namespace djpete::evaluation
