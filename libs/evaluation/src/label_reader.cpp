#include "djpete/evaluation/label_reader.h"

#include <cmath>

#include "djpete/evaluation/tracking_reader.h"
#include "djpete/obs/errors.h"

namespace djpete::evaluation {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;

SE3 labelPose(const Vec3& bottom_cam, double height_m, double rotationY_rad) {
    const double c = std::cos(rotationY_rad), s = std::sin(rotationY_rad);
    Mat3 R;        // columns: the object's x (length), y (left) and z (up) in camera axes
    R << c, s, 0,  //
        0, 0, -1,  //
        -s, c, 0;
    return {R, bottom_cam - Vec3(0, height_m / 2, 0)};
}

std::vector<LabelBox> readTrackingLabels(const std::string& path) {
    const TrackingSequence sequence = readTrackingSequence(path);
    if (sequence.boxes.empty() && sequence.dontCare.empty()) {
        throw obs::InputError(path + ": is empty; expected rows of text");
    }
    return {sequence.boxes.begin(), sequence.boxes.end()};
}

}  // namespace djpete::evaluation
