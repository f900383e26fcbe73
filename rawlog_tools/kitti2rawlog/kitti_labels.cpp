#include "kitti_labels.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "djpete/obs/errors.h"
#include "text_table.h"

namespace djpete::kitti2rawlog {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;
using obs::InputError;
using obs::ObjectDetection;

namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;

/// The columns of one row that tell a box, wherever they stand.
struct Columns {
    std::size_t box, size, score, count;
};

Mat3 objectAxes(double ry_rad) {
    const double c = std::cos(ry_rad), s = std::sin(ry_rad);
    Mat3 R_cam_obj;        // columns: front, left, up of the object, seen by the camera
    R_cam_obj << c, s, 0,  //
        0, 0, -1,          //
        -s, c, 0;
    return R_cam_obj;
}

ObjectDetection detection(const TextRow& row, const Columns& at, const BoxSigma& sigma) {
    ObjectDetection d;
    const double h = row.number(at.size, "the box's height in metres");
    const double w = row.number(at.size + 1, "the box's width in metres");
    const double l = row.number(at.size + 2, "the box's length in metres");
    if (h <= 0 || w <= 0 || l <= 0) {
        throw InputError(row.where + ": box size " + row.words[at.size] + " " +
                         row.words[at.size + 1] + " " + row.words[at.size + 2] +
                         " is not positive; expected height, width, length in metres");
    }
    d.size_m = Vec3(l, w, h);
    const Vec3 bottom(row.number(at.size + 3, "x of the box in metres"),
                      row.number(at.size + 4, "y of the box in metres"),
                      row.number(at.size + 5, "z of the box in metres"));
    d.T_sensor_obj = boxPose(bottom, h, row.number(at.size + 6, "rotation_y in radians"));
    d.information = obs::diagonalInformation(Vec3::Constant(sigma.position_m),
                                             Vec3::Constant(sigma.rotation_deg * kRadPerDeg));
    obs::ImageBox box;
    box.left = static_cast<float>(row.number(at.box, "the image box's left"));
    box.top = static_cast<float>(row.number(at.box + 1, "the image box's top"));
    box.right = static_cast<float>(row.number(at.box + 2, "the image box's right"));
    box.bottom = static_cast<float>(row.number(at.box + 3, "the image box's bottom"));
    if (box.area() > 0) d.box = box;
    if (at.score < at.count) d.score = static_cast<float>(row.number(at.score, "the score"));
    return d;
}

uint64_t frameOf(const TextRow& row) {
    const int64_t frame = row.integer(0, "the frame number");
    if (frame < 0) throw InputError(row.where + ": frame " + row.words[0] + " is negative");
    return static_cast<uint64_t>(frame);
}

std::string pointRcnnType(const std::string& word) {
    if (word == "1") return "Pedestrian";
    if (word == "2") return "Car";
    if (word == "3") return "Cyclist";
    return word;
}

/// Frame of a file that has no frame column.
uint64_t frameOfName(const std::filesystem::path& file, const TextRow& row) {
    const std::string stem = file.stem().string();
    const bool digits =
        !stem.empty() && stem.size() < 19 &&
        std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!digits) {
        throw InputError(row.where + ": " + std::to_string(row.words.size()) +
                         " columns mean no frame column, so the file's name must be the frame's "
                         "number, e.g. 000012.txt");
    }
    return std::stoull(stem);
}

[[noreturn]] void wrongColumns(const TextRow& row, bool commas) {
    throw InputError(row.where + ": " + std::to_string(row.words.size()) + " columns; expected " +
                     (commas ? "15, comma-separated (frame, type, image box, score, h, w, l, x, "
                               "y, z, ry, alpha)"
                             : "17 or 18 of KITTI's tracking labels, or 15 or 16 of its object "
                               "labels"));
}

void readRow(const TextRow& row, bool commas, const std::filesystem::path& file,
             const BoxSigma& sigma, const std::string& source, FramedDetections& out) {
    const std::size_t n = row.words.size();
    ObjectDetection d;
    uint64_t frame = 0;
    if (commas) {
        if (n != 15) wrongColumns(row, true);
        frame = frameOf(row);
        d = detection(row, {2, 7, 6, n}, sigma);
        const std::string type = pointRcnnType(row.words[1]);
        if (std::isdigit(static_cast<unsigned char>(type[0])) != 0) {
            throw InputError(row.where + ": type '" + type +
                             "'; expected a word or 1, 2, 3 for Pedestrian, Car, Cyclist");
        }
        d.objectClass = obs::objectClassFromString(type);
    } else if (n == 17 || n == 18) {
        frame = frameOf(row);
        const int64_t track = row.integer(1, "the track number");
        if (row.words[2] == "DontCare") return;
        d = detection(row, {6, 10, 17, n}, sigma);
        if (track > std::numeric_limits<int32_t>::max()) {
            throw InputError(row.where + ": track " + row.words[1] + " is too large");
        }
        if (track >= 0) d.sourceTrackId = static_cast<int32_t>(track);
        d.objectClass = obs::objectClassFromString(row.words[2]);
    } else if (n == 15 || n == 16) {
        frame = frameOfName(file, row);
        if (row.words[0] == "DontCare") return;
        d = detection(row, {4, 8, 15, n}, sigma);
        d.objectClass = obs::objectClassFromString(row.words[0]);
    } else {
        wrongColumns(row, false);
    }
    d.source = source;
    out[frame].push_back(std::move(d));
}

}  // namespace

SE3 boxPose(const Vec3& bottomCentre_cam, double height_m, double ry_rad) {
    return {objectAxes(ry_rad), bottomCentre_cam - Vec3(0, 0.5 * height_m, 0)};
}

FramedDetections readDetectionFile(const std::filesystem::path& file, const BoxSigma& sigma,
                                   const std::string& source) {
    const auto table = readTable(file, "KITTI labels or detections");
    FramedDetections out;
    for (const auto& row : table.rows) readRow(row, table.commas, file, sigma, source, out);
    return out;
}

FramedDetections readDetectionFiles(const FramedFiles& files, const BoxSigma& sigma,
                                    const std::string& source) {
    FramedDetections out;
    for (const auto& [frame, file] : files) {
        for (auto& [f, detections] : readDetectionFile(file, sigma, source)) {
            auto& into = out[f];
            into.insert(into.end(), detections.begin(), detections.end());
        }
    }
    return out;
}

}  // namespace djpete::kitti2rawlog
