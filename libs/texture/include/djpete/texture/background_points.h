/// Points of one view that are not yet judged to be background or object.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/texture/texture_view.h"

namespace djpete::texture {

/// One point of a scan or of dense stereo, and what the image shows there.
struct ViewPoint {
    geometry::Vec3 p_cam{0, 0, 0};        ///< left camera of the view
    bool coloured = false;                ///< the image sees it
    std::array<uint8_t, 3> rgb{0, 0, 0};  ///< if coloured
};

/// What viewPoints() may give.
struct ViewPointRange {
    double scan_m = 40, stereo_m = 25;  ///< from the camera
    bool unseen = false;                ///< scan points that the image does not see, too
};

/// Points of the scan, or of dense stereo at half resolution if the view has no scan but a pair of
/// images; else none. A scan point behind nearer ones is not seen by the image. Throws
/// obs::InputError, naming the frame, if the image does not fit its calibration.
std::vector<ViewPoint> viewPoints(const TextureView& view, const ViewPointRange& range);

}  // namespace djpete::texture
