/// The mask of an object from its returns.
#pragma once

#include <optional>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/detection.h"

namespace djpete::observers {

struct MaskAndBox {
    obs::RleMask mask;
    obs::ImageBox box;  ///< bounds of the mask
};

/// Projects the points, draws each as a disc of `reach_m` at its depth so that scan lines close,
/// and fills what their outline encloses. Nothing if fewer than three points are in view.
std::optional<MaskAndBox> maskOfPoints(const std::vector<geometry::Vec3>& p_cam,
                                       const geometry::StereoCamera& camera, double reach_m);

}  // namespace djpete::observers
