#include "lidar_fit.h"

#include <cmath>

#include "scan_planes.h"

namespace djpete::calibration {

using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

constexpr int kRounds = 6;
/// A disparity's own error, pixels; only its ratio to the planes' errors matters.
constexpr double kDisparitySigma_px = 0.15;

struct State {
    double offset_px = 0, scale = 1;
    SE3 T_stated_true;  ///< from the true camera to where the calibration has it
};

void addRows(const ScanFrame& frame, const State& state, std::vector<LinearRow<8>>& rows) {
    const auto& camera = frame.camera.model;
    const SE3 T_cam_velo =
        (frame.camera.T_vehicle_cam * state.T_stated_true).inverse() * frame.T_vehicle_velo;
    const ScanView view(frame.points_velo, T_cam_velo, camera);
    const double fb = state.scale * camera.fx * camera.baseline_m;
    for (const auto& m : frame.matches) {
        const auto plane = view.planeAt(double(m.u_px), double(m.v_px));
        if (!plane) continue;
        const Vec3 ray = camera.ray({double(m.u_px), double(m.v_px)});
        const double w = plane->n.dot(ray);
        LinearRow<8> row;
        row.x << 1, camera.fx * camera.baseline_m * w, fb * w * plane->n, fb * ray.cross(plane->n);
        row.y = double(m.u_px) - double(m.uRight_px) - (fb * w + state.offset_px);
        row.sigma = std::hypot(kDisparitySigma_px, fb * w * plane->sigma);
        row.group = frame.number;
        // Another surface than the scan's: not an error of calibration.
        if (std::abs(row.y) > 0.15 * fb * w + 1) continue;
        rows.push_back(row);
    }
}

}  // namespace

LidarFit fitLidar(const std::vector<ScanFrame>& frames) {
    LidarFit out;
    State state;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<LinearRow<8>> rows;
        for (const auto& frame : frames) addRows(frame, state, rows);
        out.fit = robustFit(rows);
        if (!out.fit.solved) return out;
        const auto& d = out.fit.solution;
        state.offset_px += d[0];
        state.scale += d[1];
        state.T_stated_true = state.T_stated_true * SE3::exp(Vec6(d.tail<6>()));
    }
    out.fit.solution << state.offset_px, state.scale - 1, state.T_stated_true.log();
    out.rms_px = out.fit.scale * kDisparitySigma_px;
    return out;
}

}  // namespace djpete::calibration
