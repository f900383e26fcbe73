/// What a drive says of its rig, before and after it is put right, with the time it took.
///
///     djpete_bench_calibration DRIVE.rawlog
#include <chrono>
#include <cstdio>
#include <exception>

#include "djpete/calibration/check_drive.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete_test/ate.h"

namespace {

/// Error of the vehicle's way by odometry on images and scans, where the drive knows the truth.
void printOdometryError(const char* what, const char* rawlog,
                        const djpete::calibration::CorrectedCalibration* correction) {
    djpete::obs::RawlogSource source(rawlog);
    djpete::frontend::VisualOdometry odometry;
    std::vector<djpete::geometry::SE3> estimate, truth;
    while (const auto frame = source.next()) {
        auto images = frame->loadMainImages();
        if (!images || !frame->T_world_vehicle_truth) continue;
        if (correction) images = correction->apply(*images);
        const auto scan = frame->loadScan();
        const auto keyframe = odometry.process(
            {frame->id, frame->stamp, *images, scan ? &*scan : nullptr, std::nullopt});
        estimate.push_back(keyframe->T_odom_cam * images->camera.T_vehicle_cam.inverse());
        truth.push_back(*frame->T_world_vehicle_truth);
        frame->unload();
    }
    if (estimate.size() < 3) return;
    std::printf("%s: odometry's error (ATE, SE(3)) %.4f m over %zu frames\n", what,
                djpete_test::ateSe3_m(estimate, truth), estimate.size());
}

}  // namespace

int main(int argc, char** argv) try {
    namespace calibration = djpete::calibration;
    if (argc != 2) {
        std::fprintf(stderr, "expected DRIVE.rawlog\n");
        return 1;
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto report = calibration::checkDrive(argv[1], {});
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    std::printf("%s\n%s(%.1f s)\n", argv[1], calibration::toText(report).c_str(), time.count());
    const djpete::obs::RawlogSource source(argv[1]);
    const auto stated = source.info().mainCamera(source.path());
    const auto correction = calibration::corrected(stated, report);
    std::printf(
        "baseline %.5f m -> %.5f m, camera turned by %.4f deg; put right:\n%s\n",
        stated.model.baseline_m, correction.camera.model.baseline_m,
        (stated.T_vehicle_cam.inverse() * correction.camera.T_vehicle_cam).angle_rad() *
            57.29577951,
        calibration::toText(calibration::checkDrive(argv[1], {}, 0, ~uint64_t{0}, &correction))
            .c_str());
    printOdometryError("as stated", argv[1], nullptr);
    printOdometryError("put right", argv[1], &correction);
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "djpete_bench_calibration: %s\n", e.what());
    return 1;
}
