/// Is this input fit for the map?
#pragma once

#include <vector>

#include "djpete/backend/association.h"
#include "djpete/backend/statistics.h"
#include "djpete/map/slam_map.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/CObservationVisualKeyframe.h"

namespace djpete::backend {

/// Throws obs::InputError naming the frame if it does not follow the last one of `map`, or has no
/// usable camera, pose or stamp. The first frame of a drive may have any stamp.
void requireGoodFrame(const obs::CObservationVisualKeyframe& frame, const map::SlamMap& map,
                      bool firstOfDrive);

/// The features that can be used; the others are counted in `statistics.rejected`. A broken right
/// column or depth leaves a mono feature.
std::vector<obs::KeyframeFeature> goodFeatures(const obs::CObservationVisualKeyframe& frame,
                                               BackendStatistics& statistics);

/// The detections that can be used, posed in the camera of `frame`; the others are counted in
/// `statistics.rejected`.
std::vector<map::ObjectObservation> goodDetections(
    const obs::CObservationVisualKeyframe& frame,
    const obs::CObservationDetectedObjects& detections, const AssociationOptions& options,
    BackendStatistics& statistics);

}  // namespace djpete::backend
