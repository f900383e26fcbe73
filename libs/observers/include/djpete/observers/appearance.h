/// Detections learn what they look like.
#pragma once

#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::observers {

/// Sets `appearance` of every detection with an image box (or a mask) of at least some hundred
/// pixels in `images.left`: of its mask if there is one, else of the inner part of its box. Boxes
/// and masks must be in that image.
void describeAppearance(obs::CObservationDetectedObjects& detections, const obs::ImageSet& images);

}  // namespace djpete::observers
