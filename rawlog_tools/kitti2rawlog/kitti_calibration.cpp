#include "kitti_calibration.h"

#include <cmath>
#include <map>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "text_table.h"

namespace djpete::kitti2rawlog {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;
using obs::InputError;

namespace {

/// Rows by their key, without its colon.
class KeyedRows {
  public:
    explicit KeyedRows(const std::filesystem::path& file) : file_(file.string()) {
        for (auto& row : readRows(file, "a KITTI calibration file")) {
            std::string key = row.words.front();
            if (key.back() == ':') key.pop_back();
            rows_.emplace(key, std::move(row));
        }
    }
    std::optional<std::vector<double>> find(const std::vector<std::string>& keys,
                                            std::size_t count) const {
        for (const auto& key : keys) {
            const auto it = rows_.find(key);
            if (it == rows_.end()) continue;
            return it->second.numbers(1, count,
                                      "key " + key + " with " + std::to_string(count) + " numbers");
        }
        return std::nullopt;
    }
    std::vector<double> get(const std::string& key, std::size_t count) const {
        auto v = find({key}, count);
        if (!v) throw InputError(file_ + ": no entry '" + key + "'; expected KITTI's calibration");
        return *v;
    }
    const std::string& file() const { return file_; }

  private:
    std::string file_;
    std::map<std::string, TextRow> rows_;
};

Projection projection(const std::vector<double>& v, const std::string& origin,
                      const std::string& key) {
    Projection P;
    for (int i = 0; i < 12; ++i) P(i / 4, i % 4) = v[static_cast<std::size_t>(i)];
    if (P(0, 0) <= 0 || P(1, 1) <= 0 || P(0, 1) != 0 || P(1, 0) != 0) {
        throw InputError(origin + ": entry '" + key +
                         "' is no rectified projection; expected positive focal lengths and no "
                         "skew");
    }
    return P;
}

Mat3 rotation(const std::vector<double>& v, const std::string& origin, const std::string& key) {
    Mat3 R;
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = v[static_cast<std::size_t>(i)];
    if ((R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-3 ||
        R.determinant() < 0) {
        throw InputError(origin + ": the 3x3 part of entry '" + key +
                         "' is no rotation; expected orthonormal rows");
    }
    return SE3(R, Vec3::Zero()).normalised().rotation();
}

/// The motion of a 3x4 matrix given row by row.
SE3 motion(const std::vector<double>& v, const std::string& origin, const std::string& key) {
    return {rotation({v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10]}, origin, key),
            Vec3(v[3], v[7], v[11])};
}

SE3 motionOfRT(const KeyedRows& rows) {
    const auto t = rows.get("T", 3);
    return {rotation(rows.get("R", 9), rows.file(), "R"), Vec3(t[0], t[1], t[2])};
}

}  // namespace

SE3 KittiCalibration::T_vehicle_cam0() const {
    return T_cam0_velo ? T_cam0_velo->inverse() : geometry::opticalToVehicleAxes();
}

double KittiCalibration::cameraOffset_m(std::size_t i) const {
    if (!P.at(i)) {
        throw InputError(origin + ": no calibration of camera " + std::to_string(i) +
                         "; expected an entry P" + std::to_string(i));
    }
    return -(*P[i])(0, 3) / (*P[i])(0, 0);
}

obs::RigCamera KittiCalibration::rigCamera(std::size_t left, std::optional<std::size_t> right,
                                           ImageSize imageSize) const {
    const double x = cameraOffset_m(left);
    const Projection& L = *P[left];
    obs::RigCamera out;
    out.model.fx = L(0, 0);
    out.model.fy = L(1, 1);
    out.model.cx = L(0, 2);
    out.model.cy = L(1, 2);
    out.model.width_px = imageSize.width_px;
    out.model.height_px = imageSize.height_px;
    out.T_vehicle_cam = T_vehicle_cam0() * SE3(Mat3::Identity(), Vec3(x, 0, 0));
    if (right) {
        out.model.baseline_m = cameraOffset_m(*right) - x;
        const bool rectified = L.leftCols<3>().isApprox(P[*right]->leftCols<3>(), 1e-6);
        if (out.model.baseline_m <= 0 || !rectified) {
            throw InputError(origin + ": cameras " + std::to_string(left) + " and " +
                             std::to_string(*right) +
                             " are no rectified pair; expected equal intrinsics and the second "
                             "to the right of the first");
        }
    }
    return out;
}

KittiCalibration readCalibrationFile(const std::filesystem::path& file) {
    const KeyedRows rows(file);
    KittiCalibration out;
    out.origin = rows.file();
    for (std::size_t i = 0; i < 4; ++i) {
        const std::string key = "P" + std::to_string(i);
        if (auto v = rows.find({key}, 12)) out.P[i] = projection(*v, rows.file(), key);
    }
    SE3 rectify;
    if (auto v = rows.find({"R0_rect", "R_rect"}, 9)) {
        rectify = SE3(rotation(*v, rows.file(), "R_rect"), Vec3::Zero());
    }
    if (auto v = rows.find({"Tr", "Tr_velo_to_cam", "Tr_velo_cam"}, 12)) {
        out.T_cam0_velo = rectify * motion(*v, rows.file(), "Tr");
    }
    if (auto v = rows.find({"Tr_imu_to_velo", "Tr_imu_velo"}, 12)) {
        out.T_velo_imu = motion(*v, rows.file(), "Tr_imu_to_velo");
    }
    if (!out.P[0] && !out.P[2]) {
        throw InputError(rows.file() +
                         ": no camera calibration; expected lines 'P0: ...' to 'P3: ...'");
    }
    return out;
}

KittiCalibration readRawCalibration(const std::filesystem::path& folder) {
    const KeyedRows cams(folder / "calib_cam_to_cam.txt");
    KittiCalibration out;
    out.origin = cams.file();
    for (std::size_t i = 0; i < 4; ++i) {
        const std::string n = "0" + std::to_string(i);
        if (auto v = cams.find({"P_rect_" + n}, 12))
            out.P[i] = projection(*v, cams.file(), "P_rect_" + n);
        if (auto v = cams.find({"S_rect_" + n}, 2)) {
            out.size[i] = ImageSize{static_cast<int>((*v)[0]), static_cast<int>((*v)[1])};
        }
    }
    if (!out.P[0] && !out.P[2]) {
        throw InputError(cams.file() + ": no camera calibration; expected lines 'P_rect_00: ...'");
    }
    const auto velo = folder / "calib_velo_to_cam.txt";
    if (std::filesystem::exists(velo)) {
        const SE3 rectify(rotation(cams.get("R_rect_00", 9), cams.file(), "R_rect_00"),
                          Vec3::Zero());
        out.T_cam0_velo = rectify * motionOfRT(KeyedRows(velo));
    }
    const auto imu = folder / "calib_imu_to_velo.txt";
    if (std::filesystem::exists(imu)) out.T_velo_imu = motionOfRT(KeyedRows(imu));
    return out;
}

}  // namespace djpete::kitti2rawlog
