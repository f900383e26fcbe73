/// Observations one by one in, frames out.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "djpete/obs/sensor_frame.h"

namespace djpete::obs {

/// How FrameAssembler groups and numbers.
struct FrameAssemblerOptions {
    /// Observations whose stamps differ by at most this from a frame's first belong to it.
    double stampSpread_s = 0.0;
    uint64_t firstFrame = 0;        ///< FrameId of the first frame
    std::vector<uint64_t> missing;  ///< numbers to leave out, ascending
};

/// Groups observations with equal stamps into SensorFrames. They must come frame after frame; the
/// order within a frame is free. Of two observations for the same place in a frame the first is
/// kept. What has no place in a SensorFrame (comments, 2D odometry, ...) is passed over: it neither
/// begins nor ends a frame. Not thread-safe.
class FrameAssembler {
  public:
    explicit FrameAssembler(FrameAssemblerOptions options = {});

    /// The frame that `observation` ends by beginning the next one, if it does.
    std::optional<SensorFrame> add(const mrpt::obs::CObservation::Ptr& observation);
    /// The frame begun last, as complete as it is; nothing if none was begun since.
    std::optional<SensorFrame> flush();

  private:
    void begin(const mrpt::obs::CObservation& first);
    bool belongs(const mrpt::obs::CObservation& o) const;

    FrameAssemblerOptions options_;
    uint64_t nextId_ = 0;
    std::optional<SensorFrame> current_;
};

}  // namespace djpete::obs
