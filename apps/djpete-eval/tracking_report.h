/// How djpete-eval tells how well boxes are tracked.
#pragma once

#include <string>

#include "djpete/evaluation/tracking_errors.h"

namespace djpete::apps {

/// One JSON object with the figures of all drives together, and of each
/// under sequences: mota25, mota50, samota, motp, ids, frag, fp, fn, hota, deta, assa, loca,
/// recall, precision, score (threshold), labels. Shares are 0..1. Those of a drive are at the joint
/// threshold, except own_mota25, own_mota50 and own_samota, at the drive's own. What cannot be
/// computed is null.
std::string trackingJson(const evaluation::TrackingErrors& errors);

/// A table for people, in percent.
std::string trackingTable(const evaluation::TrackingErrors& errors);

}  // namespace djpete::apps
