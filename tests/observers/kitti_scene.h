/// Raw KITTI files for the tests of detectors: scans, calibration, labels, and the comparison.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "djpete/obs/calibration.h"
#include "djpete/obs/detection.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete_test {

inline djpete::obs::LidarScan readKittiScan(const std::filesystem::path& file) {
    djpete::obs::LidarScan scan;
    std::ifstream in(file, std::ios::binary);
    float v[4];
    while (in.read(reinterpret_cast<char*>(v), sizeof v)) {
        scan.points.push_back({v[0], v[1], v[2], v[3]});
    }
    return scan;
}

/// The numbers after `key:` in a KITTI calibration file.
inline std::vector<double> kittiNumbers(const std::filesystem::path& file, const std::string& key) {
    std::ifstream in(file);
    std::vector<double> out;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind(key + ":", 0) != 0) continue;
        std::istringstream numbers(line.substr(key.size() + 1));
        for (double n; numbers >> n;) out.push_back(n);
    }
    return out;
}

inline djpete::geometry::Mat3 rowMajor(const std::vector<double>& n) {
    djpete::geometry::Mat3 R;
    R << n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8];
    return R;
}

/// Camera 0 of a raw drive; vehicle = velo.
inline djpete::obs::RigCamera readRawCamera(const std::filesystem::path& dateFolder) {
    using djpete::geometry::SE3;
    const auto camera = dateFolder / "calib_cam_to_cam.txt",
               velo = dateFolder / "calib_velo_to_cam.txt";
    const auto P = kittiNumbers(camera, "P_rect_00"), S = kittiNumbers(camera, "S_rect_00");
    const auto t = kittiNumbers(velo, "T");
    const SE3 T_rect_cam(rowMajor(kittiNumbers(camera, "R_rect_00")), {0, 0, 0});
    const SE3 T_cam_velo(rowMajor(kittiNumbers(velo, "R")), {t[0], t[1], t[2]});
    djpete::obs::RigCamera out;
    out.model = {P[0], P[5], P[2], P[6], 0, static_cast<int>(S[0]), static_cast<int>(S[1])};
    out.T_vehicle_cam = (T_rect_cam * T_cam_velo).inverse().normalised();
    return out;
}

struct KittiLabel {
    int frame = 0, track = 0, occluded = 0;
    std::string type;
    djpete::obs::ImageBox box;
    djpete::geometry::Vec3 size_m;  ///< (length, width, height)
    djpete::geometry::SE3 T_vehicle_obj;
    bool isCar() const { return type == "Car" || type == "Van"; }
    double range_m() const { return T_vehicle_obj.translation().head<2>().norm(); }
};

/// Lines of a tracking label file, by frame; DontCare included.
inline std::map<int, std::vector<KittiLabel>> readTrackingLabels(
    const std::filesystem::path& file, const djpete::geometry::SE3& T_vehicle_cam) {
    using namespace djpete::geometry;
    std::map<int, std::vector<KittiLabel>> out;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream s(line);
        KittiLabel l;
        double truncated, alpha, h, w, len, x, y, z, ry;
        s >> l.frame >> l.track >> l.type >> truncated >> l.occluded >> alpha >> l.box.left >>
            l.box.top >> l.box.right >> l.box.bottom >> h >> w >> len >> x >> y >> z >> ry;
        l.size_m = {len, w, h};
        Mat3 R;  // obj x = length, y = left, z = up, in the camera's x right, y down, z forward
        R.col(0) = Vec3(std::cos(ry), 0, -std::sin(ry));
        R.col(2) = Vec3(0, -1, 0);
        R.col(1) = R.col(2).cross(R.col(0));
        l.T_vehicle_obj = T_vehicle_cam * SE3(R, Vec3(x, y - 0.5 * h, z));
        out[l.frame].push_back(l);
    }
    return out;
}

/// Detections against labels; distances in the ground plane.
struct DetectionTally {
    static constexpr double kMatch_m = 1.5;
    struct Found {
        double range_m, centreError_m, yawError_rad;
        djpete::geometry::Vec3
            normalised;  ///< centre error along (length, width, height) over sigma
        double yawOverSigma;
    };
    int labels = 0, alarms = 0;
    std::vector<Found> found;

    double recall() const { return labels ? static_cast<double>(found.size()) / labels : 1.0; }
    double precision() const {
        const auto hits = static_cast<double>(found.size());
        return hits + alarms > 0 ? hits / (hits + alarms) : 1.0;
    }
    static double median(std::vector<double> v) {
        if (v.empty()) return 0;
        std::sort(v.begin(), v.end());
        return v[v.size() / 2];
    }
    double medianCentre_m() const {
        std::vector<double> v;
        for (const auto& f : found) v.push_back(f.centreError_m);
        return median(v);
    }
    double medianYaw_rad() const {
        std::vector<double> v;
        for (const auto& f : found) v.push_back(f.yawError_rad);
        return median(v);
    }
};

/// Adds one frame: labelled cars and vans with range in [rangeMin_m, rangeMax_m), each taking the
/// nearest free detection within kMatch_m. A detection in that range and in the image that matches
/// no label of any vehicle, nor lies in a DontCare area, is a false alarm.
inline void addFrame(DetectionTally& tally, const std::vector<KittiLabel>& labels,
                     const std::vector<djpete::obs::ObjectDetection>& detections,
                     const djpete::obs::RigCamera& camera, double rangeMin_m, double rangeMax_m) {
    using namespace djpete::geometry;
    std::vector<bool> used(detections.size(), false);
    for (const auto& l : labels) {
        if (!l.isCar()) continue;
        int best = -1;
        double bestDistance = DetectionTally::kMatch_m;
        for (std::size_t i = 0; i < detections.size(); ++i) {
            const Vec3 d = detections[i].T_sensor_obj.translation() - l.T_vehicle_obj.translation();
            if (used[i] || d.head<2>().norm() >= bestDistance) continue;
            best = static_cast<int>(i);
            bestDistance = d.head<2>().norm();
        }
        const bool counts = l.range_m() >= rangeMin_m && l.range_m() < rangeMax_m;
        tally.labels += counts ? 1 : 0;
        if (best < 0) continue;
        used[static_cast<std::size_t>(best)] = true;
        if (!counts) continue;
        const auto& d = detections[static_cast<std::size_t>(best)];
        const double turn =
            std::abs(wrapAngle(d.T_sensor_obj.yaw_rad() - l.T_vehicle_obj.yaw_rad()));
        const double yaw = std::min(turn, 3.14159265358979 - turn);
        const Vec3 inObj = d.T_sensor_obj.inverse() * l.T_vehicle_obj.translation();
        const Vec3 info(d.information(0, 0), d.information(1, 1), d.information(2, 2));
        tally.found.push_back({l.range_m(), bestDistance, yaw, inObj.cwiseProduct(info.cwiseSqrt()),
                               yaw * std::sqrt(d.information(5, 5))});
    }
    for (std::size_t i = 0; i < detections.size(); ++i) {
        const Vec3 p = detections[i].T_sensor_obj.translation();
        const double range = p.head<2>().norm();
        const Vec3 p_cam = camera.T_vehicle_cam.inverse() * p;
        if (used[i] || range < rangeMin_m || range >= rangeMax_m || p_cam.z() < 1) continue;
        const Vec2 uv = camera.model.project(p_cam);
        if (!camera.model.contains(uv)) continue;
        const bool excused = std::any_of(labels.begin(), labels.end(), [&](const KittiLabel& l) {
            if (l.type == "DontCare") {
                return uv.x() > l.box.left && uv.x() < l.box.right && uv.y() > l.box.top &&
                       uv.y() < l.box.bottom;
            }
            return l.type == "Truck" && (l.T_vehicle_obj.translation() - p).head<2>().norm() < 4.0;
        });
        if (!excused) ++tally.alarms;
    }
}

inline std::string kittiNumber(int n, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*d", digits, n);
    return text;
}

}  // namespace djpete_test
