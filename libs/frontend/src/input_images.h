/// Checked grey images of one frame.
#pragma once

#include <opencv2/core.hpp>

#include "djpete/frontend/visual_odometry.h"

namespace djpete::frontend {

struct InputImages {
    cv::Mat leftGrey;
    cv::Mat rightGrey;      ///< empty: none
    cv::Mat leftColour;     ///< BGR; empty for grey cameras
    cv::Mat exclusion;      ///< 8 bit; empty: none
    obs::RigCamera camera;  ///< with the size of the images
};

/// Checks and converts. Throws obs::InputError as VisualOdometry::process promises for one frame.
InputImages checkedImages(const OdometryInput& input);

}  // namespace djpete::frontend
