/// Reads a drive one frame ahead of whoever uses it.
#pragma once

#include <future>
#include <limits>
#include <optional>

#include "djpete/obs/rawlog_source.h"

namespace djpete::pipeline {

/// A frame with its images and scan already in memory.
struct LoadedFrame {
    obs::SensorFrame frame;
    std::optional<obs::ImageSet> images;  ///< for odometry
    std::optional<obs::LidarScan> scan;
};

/// Loads images and scan of `frame`. Throws obs::InputError naming the file.
LoadedFrame loadFrame(const obs::SensorFrame& frame);

/// Decodes frame k+1 on another thread while frame k is processed. The order and content of frames
/// do not depend on it. An error met while reading ahead is thrown by the call that would have
/// returned that frame.
class FramePrefetcher {
  public:
    /// Gives the frames from `begin` to before `end`; images and scans of others are not read.
    /// `source` must outlive this object and not be used by others meanwhile.
    explicit FramePrefetcher(obs::RawlogSource& source, obs::FrameId begin = {},
                             obs::FrameId end = {std::numeric_limits<uint64_t>::max()});
    /// Waits for the frame being read.
    ~FramePrefetcher();
    FramePrefetcher(const FramePrefetcher&) = delete;
    FramePrefetcher& operator=(const FramePrefetcher&) = delete;

    /// The next frame, or nothing at the end.
    std::optional<LoadedFrame> next();

  private:
    void start();

    obs::RawlogSource& source_;
    obs::FrameId begin_, end_;
    std::future<std::optional<LoadedFrame>> ahead_;
};

}  // namespace djpete::pipeline
