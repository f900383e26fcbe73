/// A drive, one SensorFrame after another.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "djpete/obs/sensor_frame.h"

namespace djpete::obs {

struct RawlogSourceOptions {
    /// Observations whose stamps differ by at most this belong to one frame (0 for KITTI).
    double stampSpread_s = 0.0;
};

/// Reads a rawlog lazily: observations (or sensory frames) with equal stamps become one
/// SensorFrame. Any MRPT rawlog with rectified images or 3D scans works; the head comment that
/// kitti2rawlog writes adds the calibration and the drive's own frame numbers. Damaged files raise
/// InputError at the point of damage, after all frames before it were handed out.
///
/// MRPT keeps the folder of external images in one process-wide variable; constructing a source
/// sets it (to `<name>_Images` beside the rawlog if that exists, else to the rawlog's folder), so
/// read one drive at a time.
class RawlogSource {
  public:
    /// Opens `rawlog` and reads its head. Throws InputError if it is missing or no rawlog.
    explicit RawlogSource(const std::filesystem::path& rawlog, RawlogSourceOptions options = {});
    ~RawlogSource();
    RawlogSource(RawlogSource&&) noexcept;
    RawlogSource& operator=(RawlogSource&&) noexcept;

    /// The head comment, or an empty DriveInfo for a rawlog without one.
    const DriveInfo& info() const;
    const std::string& path() const;
    /// The next frame in file order, or nothing at the end.
    std::optional<SensorFrame> next();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads the companion rawlog of detections whole: one entry per stamp, in file order.
/// Throws InputError like RawlogSource, also if it has a head that promises more frames.
std::vector<CObservationDetectedObjects::Ptr> readDetections(const std::filesystem::path& rawlog);

}  // namespace djpete::obs
