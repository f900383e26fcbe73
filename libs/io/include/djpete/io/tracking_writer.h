/// Objects as results of KITTI's tracking benchmark.
#pragma once

#include <string>

#include "djpete/map/slam_map.h"

namespace djpete::io {

struct TrackingOptions {
    /// Objects go on before their first and after their last detection for so many frames, as long
    /// as they are in view.
    unsigned before = 1, after = 0;
    /// Longer gaps between detections stay empty.
    unsigned maxGap = 10;
};

/// One row for each object and each frame from its first detection to its last, also in shorter
/// gaps between detections, as long as its centre is in front of the camera and its box in the
/// image: `frame id type truncated occluded alpha x1 y1 x2 y2 h w l x y z rotation_y score`, (x, y,
/// z) the centre of the box's bottom face and all in the camera of the map's keyframes (KITTI's
/// camera 0 for grey drives). The image box is the detection's, else the projection of the box.
/// `truncated` is the share of the projection outside the image, `occluded` is -1 (unknown). The
/// score is the same in all rows of an object: how surely it is one (map::objectScore). Frames
/// count from `first`, which is frame 0.
void writeTracking(const map::SlamMap& map, const std::string& file, map::FrameId first = {},
                   const TrackingOptions& options = {});

}  // namespace djpete::io
