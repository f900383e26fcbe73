/// Objects in the image: boxes, outlines, and where they hide the static world.
#pragma once

#include <mrpt/img/CImage.h>

#include <optional>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/cuboid.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/calibration.h"

namespace djpete::observers {

/// Convex outline, in pixels, of the part of the box with z_cam >= nearPlane_m; counter-clockwise
/// in (u right, v down) as cv::convexHull gives it, not clipped to the image. Empty if the whole
/// box is behind that plane.
std::vector<geometry::Vec2> cuboidHull(const geometry::Cuboid& cuboid,
                                       const geometry::SE3& T_cam_obj,
                                       const geometry::StereoCamera& camera,
                                       double nearPlane_m = 0.1);

/// Axis-aligned bounds of cuboidHull, clipped to the image; nothing if the box is not in view.
std::optional<obs::ImageBox> projectCuboid(const geometry::Cuboid& cuboid,
                                           const geometry::SE3& T_cam_obj,
                                           const geometry::StereoCamera& camera,
                                           double nearPlane_m = 0.1);

/// 8-bit grey image of the camera's size: 255 where an object is, else 0. An object is its mask if
/// it has one of the image's size, grown by `margin_px` (a disc), else the outline of its projected
/// box grown alike. Throws obs::InputError if the camera has no image size or `margin_px` is
/// negative.
mrpt::img::CImage exclusionImage(const obs::CObservationDetectedObjects& objects,
                                 const obs::RigCamera& camera, int margin_px);

}  // namespace djpete::observers
