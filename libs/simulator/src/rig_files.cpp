#include "rig_files.h"

#include <cmath>

#include "djpete/simulator/oxts.h"
#include "image_files.h"
#include "number_rows.h"

namespace djpete::simulator {

namespace fs = std::filesystem;
using geometry::SE3;
using geometry::Vec3;

namespace {

constexpr double kTimeJump_s = 1.0;
constexpr double kTilt_rad = M_PI / 180.0;

double statedBaseline(double baseline_m, const std::vector<Fault>& faults) {
    if (hasFault(faults, FaultKind::LongBaseline)) baseline_m *= 1.01;
    if (hasFault(faults, FaultKind::ShortBaseline)) baseline_m *= 0.99;
    return baseline_m;
}

SE3 statedExtrinsics(const SE3& T_cam_velo, const std::vector<Fault>& faults) {
    if (!hasFault(faults, FaultKind::ExtrinsicTilt)) return T_cam_velo;
    return SE3(geometry::so3Exp(Vec3(kTilt_rad, 0, 0)), Vec3::Zero()) * T_cam_velo;
}

}  // namespace

void writeCalibration(const geometry::StereoCamera& camera, const SE3& T_vehicle_cam,
                      const std::vector<Fault>& faults, const fs::path& folder) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
        const double offset =
            i % 2 == 1 ? -camera.fx * statedBaseline(camera.baseline_m, faults) : 0.0;
        text += "P" + std::to_string(i) + ":" +
                numberRow({camera.fx, 0, camera.cx, offset, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0},
                          " %.12e") +
                "\n";
    }
    text += "Tr: " + poseRow(statedExtrinsics(T_vehicle_cam.inverse(), faults)) + "\n";
    writeWhole(folder / "calib.txt", text);

    const SE3 T = T_velo_imu();  // p_velo = R p_imu + T
    std::string imu = "calib_time: 01-Jan-2000 00:00:00\nR:";
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) imu += numberRow({T.rotation()(r, c)}, " %.6e");
    }
    const Vec3 t = T.translation();
    imu += "\nT:" + numberRow({t.x(), t.y(), t.z()}, " %.6e") + "\n";
    writeWhole(folder / "calib_imu_to_velo.txt", imu);
}

void writeTimesAndPoses(const World& world, uint64_t end, const SE3& T_vehicle_cam,
                        const std::vector<Fault>& faults, const fs::path& folder) {
    std::string times, poses;
    const SE3 T_first_world = (world.T_world_start() * T_vehicle_cam).inverse();
    for (uint64_t f = 0; f < end; ++f) {
        const double jump = isFaulty(faults, FaultKind::TimeJump, f) ? kTimeJump_s : 0.0;
        times += numberRow({static_cast<double>(f) * world.options().period_s + jump}, "%.6e\n");
        poses += poseRow(T_first_world * world.T_world_vehicle(f) * T_vehicle_cam) + "\n";
    }
    writeWhole(folder / "times.txt", times);
    writeWhole(folder / "poses.txt", poses);
}

}  // namespace djpete::simulator
