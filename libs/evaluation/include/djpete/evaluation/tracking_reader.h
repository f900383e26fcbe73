/// Reads labels and results of KITTI's tracking benchmark with all that an evaluation of tracking
/// needs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/label_reader.h"

namespace djpete::evaluation {

/// An upright rectangle in the image, in pixels.
struct ImageArea {
    double left = 0, top = 0, right = 0, bottom = 0;

    double width() const { return right - left; }
    double height() const { return bottom - top; }
    double area() const { return std::max(0.0, width()) * std::max(0.0, height()); }
};

/// A labelled or tracked 3D box with the other columns of its row. T_cam_obj is the pose in the
/// rectified camera 0 of its frame.
struct TrackingBox : LabelBox {
    double truncation = 0;  ///< 0 not truncated; larger: more so
    double occlusion = 0;   ///< 0 visible, 1 partly, 2 largely occluded, 3 unknown
    ImageArea image;
    std::optional<double> score;  ///< of a result; larger is surer
};

/// A part of an image that nobody labelled.
struct DontCareArea {
    std::size_t frame = 0;
    ImageArea image;
};

/// All rows of one file: one drive.
struct TrackingSequence {
    std::string name;  ///< the file's name without folder and ending, e.g. "0006"
    std::vector<TrackingBox> boxes;
    std::vector<DontCareArea> dontCare;
};

/// Rows `frame track type truncated occluded alpha x1 y1 x2 y2 h w l x y z rotation_y [score]`.
/// Types in any case; DontCare rows are kept apart. An empty file is a drive without a box (a
/// tracker may find none). Throws obs::InputError naming file and line if the file is missing, a
/// row has not 17 or 18 columns, a number is malformed or not finite, a size is not positive, a
/// track has two boxes in one frame, or some boxes have a score and others have none.
TrackingSequence readTrackingSequence(const std::string& path);

}  // namespace djpete::evaluation
