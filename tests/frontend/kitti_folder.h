/// Reads KITTI's own folders straight into OdometryInput: just enough for the tests of this room.
#pragma once

#include <mrpt/core/Clock.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "djpete/frontend/visual_odometry.h"
#include "djpete/geometry/mrpt_bridge.h"

namespace djpete_test {

using djpete::geometry::SE3;

inline std::vector<double> numbersAfter(const std::filesystem::path& file, const std::string& key) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.rfind(key + ":", 0) != 0) continue;
        std::istringstream words(line.substr(key.size() + 1));
        std::vector<double> out;
        for (double x = 0; words >> x;) out.push_back(x);
        return out;
    }
    throw std::runtime_error(file.string() + ": no line " + key);
}

inline SE3 poseFromRow(const std::vector<double>& v, std::size_t at = 0) {
    djpete::geometry::Mat3 R;
    R << v.at(at), v.at(at + 1), v.at(at + 2), v.at(at + 4), v.at(at + 5), v.at(at + 6),
        v.at(at + 8), v.at(at + 9), v.at(at + 10);
    return {R, {v.at(at + 3), v.at(at + 7), v.at(at + 11)}};
}

inline std::vector<SE3> readPoses(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::vector<SE3> out;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::vector<double> row;
        for (double x = 0; words >> x;) row.push_back(x);
        if (row.size() == 12) out.push_back(poseFromRow(row));
    }
    return out;
}

/// A drive in KITTI's odometry or raw layout.
struct KittiFolder {
    std::filesystem::path left, right, scans;  ///< folders; right may be empty
    djpete::obs::RigCamera camera;
    SE3 T_vehicle_velo;
    int digits = 6;

    static std::string numbered(std::size_t i, int digits, const char* ending) {
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "%0*zu%s", digits, i, ending);
        return name.data();
    }
    /// Cameras 0, 1 (grey) or 2, 3 (colour) of an odometry sequence.
    static KittiFolder odometry(const std::filesystem::path& sequence, bool colour) {
        KittiFolder k;
        k.left = sequence / (colour ? "image_2" : "image_0");
        k.right = sequence / (colour ? "image_3" : "image_1");
        k.scans = sequence / "velodyne";
        const auto pLeft = numbersAfter(sequence / "calib.txt", colour ? "P2" : "P0");
        const auto pRight = numbersAfter(sequence / "calib.txt", colour ? "P3" : "P1");
        const SE3 T_cam0_velo = poseFromRow(numbersAfter(sequence / "calib.txt", "Tr"));
        k.setCamera(pLeft, pRight, T_cam0_velo);
        return k;
    }
    /// Camera 0 and scans of a raw drive; calibration beside its folder.
    static KittiFolder rawMono(const std::filesystem::path& drive) {
        KittiFolder k;
        k.left = drive / "image_00" / "data";
        k.scans = drive / "velodyne_points" / "data";
        k.digits = 10;
        const auto date = drive.parent_path();
        const auto R = numbersAfter(date / "calib_velo_to_cam.txt", "R");
        const auto t = numbersAfter(date / "calib_velo_to_cam.txt", "T");
        const auto Rr = numbersAfter(date / "calib_cam_to_cam.txt", "R_rect_00");
        djpete::geometry::Mat3 R_cam_velo, R_rect;
        R_cam_velo << R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8];
        R_rect << Rr[0], Rr[1], Rr[2], Rr[3], Rr[4], Rr[5], Rr[6], Rr[7], Rr[8];
        const auto p = numbersAfter(date / "calib_cam_to_cam.txt", "P_rect_00");
        k.setCamera(p, {}, SE3(R_rect, {0, 0, 0}) * SE3(R_cam_velo, {t[0], t[1], t[2]}));
        return k;
    }

    djpete::frontend::OdometryInput load(std::size_t i, djpete::obs::LidarScan& scanStorage) const {
        djpete::frontend::OdometryInput in;
        in.frame.value = i;
        in.stamp = mrpt::Clock::fromDouble(1.3e9 + 0.1 * static_cast<double>(i));
        in.images.camera = camera;
        const std::string name = numbered(i, digits, ".png");
        loadImage(in.images.left, left / name);
        if (!right.empty()) loadImage(in.images.right.emplace(), right / name);
        const auto scan = scans / numbered(i, digits, ".bin");
        if (std::filesystem::exists(scan)) {
            scanStorage = readScan(scan);
            in.scan = &scanStorage;
        }
        return in;
    }

  private:
    void setCamera(const std::vector<double>& pLeft, const std::vector<double>& pRight,
                   const SE3& T_cam0_velo) {
        auto& m = camera.model;
        m.fx = pLeft[0];
        m.fy = pLeft[5];
        m.cx = pLeft[2];
        m.cy = pLeft[6];
        if (!pRight.empty()) m.baseline_m = (pLeft[3] - pRight[3]) / pLeft[0];
        const SE3 T_cam_cam0({Eigen::Matrix3d::Identity()}, {pLeft[3] / pLeft[0], 0, 0});
        camera.T_vehicle_cam = (T_cam_cam0 * T_cam0_velo).inverse().normalised();
    }
    static void loadImage(mrpt::img::CImage& image, const std::filesystem::path& file) {
        if (!image.loadFromFile(file.string()))
            throw std::runtime_error("cannot read " + file.string());
    }
    djpete::obs::LidarScan readScan(const std::filesystem::path& file) const {
        djpete::obs::LidarScan out;
        out.T_vehicle_velo = T_vehicle_velo;
        std::ifstream in(file, std::ios::binary);
        for (std::array<float, 4> p{}; in.read(reinterpret_cast<char*>(p.data()), 16);)
            out.points.push_back({p[0], p[1], p[2], p[3]});
        return out;
    }
};

}  // namespace djpete_test
