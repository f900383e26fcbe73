#include "djpete/calibration/calibration_check.h"

#include <cmath>

#include "djpete/obs/errors.h"
#include "lidar_fit.h"
#include "right_match.h"
#include "robust_fit.h"
#include "verdicts.h"

namespace djpete::calibration {

namespace {

/// Scans kept at most; beyond, every second one goes and only every second, fourth ... comes in.
constexpr std::size_t kMaxScans = 60;
/// Corners farther tell of the offset only through noise.
constexpr double kMaxRange_m = 50;
/// Frames below which the spread between frames is no measure of an error.
constexpr std::size_t kMinFrames = 4;
/// What stays whatever the number of measurements: patches are matched without shear, which slanted
/// surfaces have, and planes through a scan's points touch edges. Sizes as seen on made-up streets.
constexpr double kFloor_px = 0.01, kFloorScale = 5e-4, kFloorShift_m = 5e-3,
                 kFloorTilt_rad = 3.5e-4;

Estimate estimate(double value, double sigma, double floor, bool known) {
    return {value, std::hypot(sigma, floor), known};
}

}  // namespace

bool Estimate::deviates(double nominal, double matters) const {
    const double e = std::abs(value - nominal);
    return known && e > 3 * sigma && e > matters;
}

struct CalibrationCheck::Impl {
    std::vector<LinearRow<3>> rows;
    std::vector<ScanFrame> scans;
    std::size_t frames = 0, scansSeen = 0, stride = 1;

    void add(const frontend::OdometryInput& input,
             const obs::CObservationVisualKeyframe& odometry) {
        if (!odometry.isKeyframe || !input.images.right) return;
        const auto matches = matchRight(input, odometry);
        const auto& camera = input.images.camera.model;
        for (const auto& m : matches) {
            LinearRow<3> row;
            row.x << 1, (double(m.uRight_px) - camera.cx) / camera.fx,
                (double(m.v_px) - camera.cy) / camera.fy;
            row.y = double(m.vRight_px) - double(m.v_px);
            row.group = frames;
            rows.push_back(row);
        }
        if (input.scan && scansSeen++ % stride == 0) keepScan(input, matches);
        ++frames;
    }

    void keepScan(const frontend::OdometryInput& input, const std::vector<RightMatch>& matches) {
        ScanFrame frame;
        frame.number = frames;
        frame.camera = input.images.camera;
        if (frame.camera.model.width_px <= 0 || frame.camera.model.height_px <= 0) {
            frame.camera.model.width_px = int(input.images.left.getWidth());
            frame.camera.model.height_px = int(input.images.left.getHeight());
        }
        frame.T_vehicle_velo = input.scan->T_vehicle_velo;
        const geometry::SE3 T_cam_velo =
            frame.camera.T_vehicle_cam.inverse() * frame.T_vehicle_velo;
        for (const auto& p : input.scan->points) {
            const double z = (T_cam_velo * p.position()).z();
            if (z > 1 && z < kMaxRange_m) frame.points_velo.emplace_back(p.x, p.y, p.z);
        }
        frame.matches = matches;
        scans.push_back(std::move(frame));
        if (scans.size() < kMaxScans) return;
        std::vector<ScanFrame> half;
        for (std::size_t i = 0; i < scans.size(); i += 2) half.push_back(std::move(scans[i]));
        scans = std::move(half);
        stride *= 2;
    }

    RowCheck rowCheck() const {
        RowCheck out;
        const auto fit = robustFit(rows);
        const bool known = fit.solved && fit.groups >= kMinFrames;
        out.offset_px = estimate(fit.solution[0], fit.sigma[0], kFloor_px, known);
        out.perColumn_px = estimate(fit.solution[1], fit.sigma[1], kFloor_px, known);
        out.perRow_px = estimate(fit.solution[2], fit.sigma[2], kFloor_px, known);
        out.rms_px = fit.scale;
        out.measurements = fit.used;
        out.frames = fit.groups;
        return out;
    }
};

CalibrationCheck::CalibrationCheck() : impl_(std::make_unique<Impl>()) {}
CalibrationCheck::~CalibrationCheck() = default;
CalibrationCheck::CalibrationCheck(CalibrationCheck&&) noexcept = default;
CalibrationCheck& CalibrationCheck::operator=(CalibrationCheck&&) noexcept = default;

void CalibrationCheck::add(const frontend::OdometryInput& input,
                           const obs::CObservationVisualKeyframe& odometry) {
    impl_->add(input, odometry);
}

CalibrationReport CalibrationCheck::report() const {
    CalibrationReport out;
    out.rows = impl_->rowCheck();
    const LidarFit lidar = fitLidar(impl_->scans);
    const auto& fit = lidar.fit;
    const bool known = fit.solved && fit.groups >= kMinFrames;
    out.disparity.offset_px = estimate(fit.solution[0], fit.sigma[0], kFloor_px, known);
    out.disparity.scale = estimate(1 + fit.solution[1], fit.sigma[1], kFloorScale, known);
    out.disparity.rms_px = lidar.rms_px;
    Estimate* const six[] = {&out.lidar.shiftX_m,  &out.lidar.shiftY_m,  &out.lidar.shiftZ_m,
                             &out.lidar.tiltX_rad, &out.lidar.tiltY_rad, &out.lidar.tiltZ_rad};
    for (int k = 0; k < 6; ++k) {
        *six[k] = estimate(fit.solution[2 + k], fit.sigma[2 + k],
                           k < 3 ? kFloorShift_m : kFloorTilt_rad, known);
    }
    out.disparity.measurements = out.lidar.measurements = fit.used;
    out.disparity.frames = out.lidar.frames = fit.groups;
    judge(out);
    return out;
}

}  // namespace djpete::calibration
