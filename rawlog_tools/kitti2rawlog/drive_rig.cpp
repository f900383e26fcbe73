#include "drive_rig.h"

#include <algorithm>

#include "djpete/obs/errors.h"
#include "image_files.h"

namespace djpete::kitti2rawlog {

using obs::InputError;

namespace {

constexpr ImageSize kNominalSize{1242, 375};  // most raw and tracking drives

/// The first image of a camera among `frames`.
std::optional<std::filesystem::path> firstImage(const FramedFiles& images,
                                                const std::vector<uint64_t>& frames) {
    for (uint64_t f : frames) {
        const auto it = images.find(f);
        if (it != images.end()) return it->second;
    }
    return std::nullopt;
}

bool sameRig(const KittiCalibration& a, const KittiCalibration& b) {
    for (std::size_t i = 0; i < 4; ++i) {
        if (a.P[i].has_value() != b.P[i].has_value() || (a.P[i] && *a.P[i] != *b.P[i]))
            return false;
    }
    return a.T_vehicle_cam0().matrix() == b.T_vehicle_cam0().matrix();
}

KittiCalibration readObjectCalibration(const DriveFiles& drive,
                                       const std::vector<uint64_t>& frames) {
    const auto files = listFrames(drive.calibration, ".txt");
    std::optional<KittiCalibration> out;
    for (uint64_t f : frames) {
        const auto it = files.find(f);
        if (it == files.end()) {
            throw InputError(drive.calibration.string() + ": no calibration of frame " +
                             std::to_string(f));
        }
        const auto c = readCalibrationFile(it->second);
        if (out && !sameRig(*out, c)) {
            throw InputError(c.origin + ": frame " + std::to_string(f) +
                             " has another calibration than " + out->origin +
                             "; a rawlog has one rig, so convert frames of one drive with --range");
        }
        if (!out) out = c;
    }
    return *out;
}

}  // namespace

KittiCalibration readCalibration(const DriveFiles& drive, const std::vector<uint64_t>& frames) {
    if (std::filesystem::is_directory(drive.calibration)) {
        if (drive.layout == Layout::Object) return readObjectCalibration(drive, frames);
        return readRawCalibration(drive.calibration);
    }
    if (drive.layout == Layout::Raw && drive.calibration.filename() == "calib_cam_to_cam.txt") {
        return readRawCalibration(drive.calibration.parent_path());
    }
    return readCalibrationFile(drive.calibration);
}

CameraPair findPair(const DriveFiles& drive, const KittiCalibration& calibration,
                    const std::vector<uint64_t>& frames, std::size_t left) {
    CameraPair out;
    out.left = left;
    out.right = left + 1;
    const auto image = firstImage(drive.images[out.left], frames);
    out.hasLeft = image.has_value();
    out.hasRight = firstImage(drive.images[out.right], frames).has_value();
    if (image) {
        out.size = pngSize(*image);
        out.mono = calibration.rigCamera(out.left, std::nullopt, out.size);
        if (out.hasRight) out.stereo = calibration.rigCamera(out.left, out.right, out.size);
    } else if (!drive.hasImages() && calibration.P[out.left]) {
        out.size = calibration.size[out.left].value_or(kNominalSize);
        out.mono = calibration.rigCamera(out.left, std::nullopt, out.size);
        if (calibration.P[out.right])
            out.stereo = calibration.rigCamera(out.left, out.right, out.size);
    }
    return out;
}

obs::DriveInfo driveInfo(const DriveFiles& drive, const std::vector<uint64_t>& frames,
                         const CameraPair& gray, const CameraPair& color) {
    obs::DriveInfo info;
    info.name = drive.name;
    info.firstFrame = frames.front();
    info.frameCount = frames.back() - frames.front() + 1;
    std::size_t i = 0;
    for (uint64_t f = frames.front(); f < frames.back(); ++f) {
        if (frames[i] == f)
            ++i;
        else
            info.missing.push_back(f);
    }
    info.gray = gray.rig();
    info.color = color.rig();
    return info;
}

}  // namespace djpete::kitti2rawlog
