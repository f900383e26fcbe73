/// Corners of the left image found again in the right image, free in both directions.
#pragma once

#include <vector>

#include "djpete/frontend/visual_odometry.h"

namespace djpete::calibration {

struct RightMatch {
    float u_px = 0, v_px = 0;            ///< left
    float uRight_px = 0, vRight_px = 0;  ///< right; need not be the same row
};

/// Of the features that odometry found in both images; those whose way back ends elsewhere are
/// left out.
std::vector<RightMatch> matchRight(const frontend::OdometryInput& input,
                                   const obs::CObservationVisualKeyframe& odometry);

}  // namespace djpete::calibration
