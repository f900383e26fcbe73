#include "djpete/obs/sensor_frame.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include <cmath>
#include <filesystem>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"

namespace djpete::obs {

namespace {

using mrpt::img::CImage;

std::string frameName(FrameId id) { return "frame " + std::to_string(id.value); }

std::string fileOf(const CImage& image, FrameId id) {
    return image.isExternallyStored() ? image.getExternalStorageFileAbsolutePath()
                                      : frameName(id) + " (embedded image)";
}

/// Loads an externally stored image, checks it against the calibrated size and returns a copy that
/// outlives unload().
CImage loadImage(const CImage& stored, const mrpt::img::TCamera& model, FrameId id) {
    const std::string file = fileOf(stored, id);
    if (stored.isExternallyStored() && !std::filesystem::exists(file)) {
        throw InputError(file + ": image of " + frameName(id) + " does not exist");
    }
    try {
        stored.forceLoad();
    } catch (const std::exception&) {
        throw InputError(file + ": image of " + frameName(id) +
                         " cannot be decoded; expected a complete PNG");
    }
    if (stored.isEmpty() || stored.getWidth() == 0) {
        throw InputError(file + ": image of " + frameName(id) +
                         " cannot be decoded; expected a complete PNG");
    }
    if (model.ncols != 0 &&
        (stored.getWidth() != model.ncols || stored.getHeight() != model.nrows)) {
        throw InputError(file + ": image is " + std::to_string(stored.getWidth()) + "x" +
                         std::to_string(stored.getHeight()) + " but " +
                         std::to_string(model.ncols) + "x" + std::to_string(model.nrows) +
                         " was expected");
    }
    // A copy of its own: a shallow one would share, and lose, its pixels with unload().
    CImage out;
    stored.extract_patch(out, 0, 0, static_cast<unsigned>(stored.getWidth()),
                         static_cast<unsigned>(stored.getHeight()));
    return out;
}

RigCamera rigCamera(const mrpt::img::TCamera& model, double baseline_m, const geometry::SE3& T,
                    FrameId id) {
    RigCamera out;
    out.model.fx = model.fx();
    out.model.fy = model.fy();
    out.model.cx = model.cx();
    out.model.cy = model.cy();
    out.model.baseline_m = baseline_m;
    out.model.width_px = static_cast<int>(model.ncols);
    out.model.height_px = static_cast<int>(model.nrows);
    out.T_vehicle_cam = T;
    if (!out.model.valid()) {
        throw InputError(frameName(id) +
                         ": the image observation has no calibration; expected positive " +
                         "focal lengths");
    }
    for (double d : model.dist) {
        if (d != 0)
            throw InputError(frameName(id) + ": images must be rectified (zero distortion)");
    }
    return out;
}

ImageSet loadStereo(const mrpt::obs::CObservationStereoImages& o, FrameId id) {
    const auto T = geometry::fromCPose3D(mrpt::poses::CPose3D(o.cameraPose));
    const double baseline = o.hasImageRight ? o.rightCameraPose.x() : 0.0;
    if (o.hasImageRight && baseline <= 0) {
        throw InputError(frameName(id) +
                         ": stereo images without a baseline; expected it positive");
    }
    ImageSet out;
    out.camera = rigCamera(o.leftCamera, baseline, T, id);
    out.left = loadImage(o.imageLeft, o.leftCamera, id);
    if (!o.hasImageRight) return out;
    out.right = loadImage(o.imageRight, o.rightCamera, id);
    if (out.left.getWidth() != out.right->getWidth() ||
        out.left.getHeight() != out.right->getHeight()) {
        throw InputError(fileOf(o.imageRight, id) + ": right image of " + frameName(id) +
                         " has another size than the left one");
    }
    return out;
}

ImageSet loadMono(const mrpt::obs::CObservationImage& o, FrameId id) {
    ImageSet out;
    out.camera = rigCamera(o.cameraParams, 0.0, geometry::fromCPose3D(o.cameraPose), id);
    out.left = loadImage(o.image, o.cameraParams, id);
    return out;
}

void checkScanFile(const mrpt::obs::CObservationPointCloud& o, FrameId id) {
    if (!o.isExternallyStored()) return;
    const std::string file = mrpt::io::lazy_load_absolute_path(o.getExternalStorageFile());
    std::error_code error;
    const auto bytes = std::filesystem::file_size(file, error);
    if (error) throw InputError(file + ": scan of " + frameName(id) + " does not exist");
    if (file.size() > 4 && file.substr(file.size() - 4) == ".bin" &&
        (bytes % 16 != 0 || bytes == 0)) {
        throw InputError(file + ": scan of " + frameName(id) + " is truncated: " +
                         std::to_string(bytes) + " bytes, expected a positive multiple of 16");
    }
}

void unloadStereo(const mrpt::obs::CObservationStereoImages::Ptr& o) {
    if (!o) return;
    o->imageLeft.unload();  // MRPT 2.5 has no unload() for stereo observations
    o->imageRight.unload();
}

}  // namespace

std::optional<ImageSet> SensorFrame::loadMainImages() const {
    if (stereoGray) return loadStereo(*stereoGray, id);
    if (imageGray) return loadMono(*imageGray, id);
    if (stereoColor) return loadStereo(*stereoColor, id);
    if (imageColor) return loadMono(*imageColor, id);
    return std::nullopt;
}

std::optional<ImageSet> SensorFrame::loadTextureImages() const {
    if (stereoColor) return loadStereo(*stereoColor, id);
    if (imageColor) return loadMono(*imageColor, id);
    return loadMainImages();
}

std::optional<LidarScan> SensorFrame::loadScan() const {
    if (!scan) return std::nullopt;
    checkScanFile(*scan, id);
    try {
        scan->load();
    } catch (const std::exception&) {
        throw InputError(scan->getExternalStorageFile() + ": scan of " + frameName(id) +
                         " cannot be read");
    }
    if (!scan->pointcloud) throw InputError(frameName(id) + ": scan without a point cloud");
    const auto& cloud = *scan->pointcloud;
    const auto* withIntensity = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&cloud);
    const auto& xs = cloud.getPointsBufferRef_x();
    const auto& ys = cloud.getPointsBufferRef_y();
    const auto& zs = cloud.getPointsBufferRef_z();
    LidarScan out;
    out.T_vehicle_velo = geometry::fromCPose3D(scan->sensorPose);
    out.points.reserve(xs.size());
    for (std::size_t i = 0; i < xs.size(); ++i) {
        if (!std::isfinite(xs[i]) || !std::isfinite(ys[i]) || !std::isfinite(zs[i])) {
            throw InputError(
                (scan->isExternallyStored() ? scan->getExternalStorageFile() : "scan") +
                ": point " + std::to_string(i) + " of " + frameName(id) +
                " is not finite; expected metres");
        }
        if (xs[i] == 0 && ys[i] == 0 && zs[i] == 0) continue;
        out.points.push_back(
            {xs[i], ys[i], zs[i], withIntensity ? withIntensity->getPointIntensity_fast(i) : 0.F});
    }
    return out;
}

void SensorFrame::unload() const {
    unloadStereo(stereoGray);
    unloadStereo(stereoColor);
    if (imageGray) imageGray->unload();
    if (imageColor) imageColor->unload();
    if (scan) scan->unload();
}

}  // namespace djpete::obs
