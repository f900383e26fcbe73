/// Reads the labels of KITTI's tracking benchmark (label_02).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/obs/detection.h"

namespace djpete::evaluation {

/// A labelled 3D box.
struct LabelBox {
    std::size_t frame = 0;
    int64_t trackId = 0;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    geometry::Vec3 size_m{0, 0, 0};  ///< (length, width, height)
    geometry::SE3 T_cam_obj;         ///< box centre; cam = camera 0 of the same frame
};

/// T_cam_obj of a KITTI label: `bottom` is the centre of the box's bottom face; at rotation_y = 0
/// the object's x points along the camera's +x, and rotation_y turns it about the camera's y
/// (down).
geometry::SE3 labelPose(const geometry::Vec3& bottom_cam, double height_m, double rotationY_rad);

/// Rows `frame track type truncated occluded alpha x1 y1 x2 y2 h w l x y z rotation_y [score]`.
/// DontCare rows are left out (they have no 3D box). Throws obs::InputError naming file and line if
/// the file is missing or empty, a row has not 17 or 18 columns, a number is malformed or not
/// finite, a size is not positive, or a track has two boxes in one frame.
std::vector<LabelBox> readTrackingLabels(const std::string& path);

}  // namespace djpete::evaluation
