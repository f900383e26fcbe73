/// How corners look, to know them again when the drive comes back.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "djpete/obs/CObservationVisualKeyframe.h"

namespace djpete::frontend {

/// Upright BRIEF (Calonder et al. 2010): 256 comparisons of grey levels of the smoothed 8 bit image
/// about each feature. No orientation: a car's camera stays upright.
void describe(const cv::Mat& grey, std::vector<obs::KeyframeFeature>& features);

}  // namespace djpete::frontend
