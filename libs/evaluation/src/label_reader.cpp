#include "djpete/evaluation/label_reader.h"

#include <cmath>
#include <set>
#include <utility>

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;
using obs::InputError;

namespace {

LabelBox parseBox(const TextLine& line, const std::vector<std::string>& words) {
    static const char* const kNames[] = {"height", "width", "length", "x", "y", "z", "rotation_y"};
    double v[7];
    for (std::size_t i = 0; i < 7; ++i) v[i] = parseNumber(words[10 + i], line.where, kNames[i]);
    if (!(v[0] > 0 && v[1] > 0 && v[2] > 0)) {
        throw InputError(line.where + ": expected a height, width and length above 0, got " +
                         words[10] + " " + words[11] + " " + words[12]);
    }
    LabelBox box;
    box.frame = parseCount(words[0], line.where, "frame");
    box.trackId = parseInteger(words[1], line.where, "track id");
    box.objectClass = obs::objectClassFromString(words[2]);
    box.size_m = {v[2], v[1], v[0]};
    box.T_cam_obj = labelPose({v[3], v[4], v[5]}, v[0], v[6]);
    return box;
}

}  // namespace

SE3 labelPose(const Vec3& bottom_cam, double height_m, double rotationY_rad) {
    const double c = std::cos(rotationY_rad), s = std::sin(rotationY_rad);
    Mat3 R;        // columns: the object's x (length), y (left) and z (up) in camera axes
    R << c, s, 0,  //
        0, 0, -1,  //
        -s, c, 0;
    return {R, bottom_cam - Vec3(0, height_m / 2, 0)};
}

std::vector<LabelBox> readTrackingLabels(const std::string& path) {
    std::vector<LabelBox> boxes;
    std::set<std::pair<std::size_t, int64_t>> seen;
    for (const auto& line : readLines(path)) {
        const auto words = splitAtBlanks(line.text);
        if (words.size() != 17 && words.size() != 18) {
            throw InputError(line.where +
                             ": expected the 17 columns of a KITTI tracking label (or 18 with a "
                             "score), got " +
                             std::to_string(words.size()));
        }
        if (words[2] == "DontCare") continue;
        boxes.push_back(parseBox(line, words));
        if (!seen.insert({boxes.back().frame, boxes.back().trackId}).second) {
            throw InputError(line.where + ": track " + words[1] + " has two boxes in frame " +
                             words[0] + "; expected one");
        }
    }
    return boxes;
}

}  // namespace djpete::evaluation
