#include "djpete/calibration/check_drive.h"

#include "djpete/obs/errors.h"
#include "djpete/obs/rawlog_source.h"

namespace djpete::calibration {

CalibrationReport checkDrive(const std::filesystem::path& rawlog,
                             const frontend::FrontendOptions& options, uint64_t begin, uint64_t end,
                             const CorrectedCalibration* correction) {
    obs::RawlogSource source(rawlog);
    frontend::VisualOdometry odometry(options);
    CalibrationCheck check;
    bool any = false;
    while (const auto frame = source.next()) {
        if (frame->id.value >= end) break;
        auto images = frame->id.value >= begin ? frame->loadMainImages() : std::nullopt;
        if (images && images->right) {
            any = true;
            if (correction) images = correction->apply(*images);
            frontend::OdometryInput input{frame->id, frame->stamp, *images, nullptr, std::nullopt};
            const auto keyframe = odometry.process(input);
            const auto scan = keyframe->isKeyframe ? frame->loadScan() : std::nullopt;
            input.scan = scan ? &*scan : nullptr;
            check.add(input, *keyframe);
        }
        frame->unload();
    }
    if (!any) {
        throw obs::InputError(rawlog.string() +
                              ": no stereo pair in the asked frames; expected some to check");
    }
    return check.report();
}

}  // namespace djpete::calibration
