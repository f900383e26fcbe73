/// Puts what an adjustment found into the map.
#pragma once

#include "djpete/backend/backbone.h"
#include "djpete/backend/statistics.h"

namespace djpete::backend {

/// Writes an update with cameras, of a problem whose newest keyframe was `issuedAt`, into the map.
/// What came since moves along.
void mergeUpdate(map::SlamMap& map, const BackboneUpdate& update, map::KeyframeId issuedAt,
                 BackendStatistics& statistics);

}  // namespace djpete::backend
