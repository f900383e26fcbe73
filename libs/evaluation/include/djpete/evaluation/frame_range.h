/// Which frames of an estimate belong to which frames of the truth.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "djpete/evaluation/trajectory_reader.h"

namespace djpete::evaluation {

/// Frames begin .. end-1.
struct FrameRange {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
};

/// Parses "A:B" with 0 <= A < B. Throws obs::InputError otherwise.
FrameRange parseFrameRange(const std::string& text);

/// The row of the estimate that belongs to frame range.begin: 0 if the estimate has exactly
/// range.size() rows (it was made from the range alone), else range.begin (it has a row for every
/// frame from 0). Throws obs::InputError if the estimate then ends before range.end.
std::size_t firstEstimateRow(const TrajectoryFile& estimate, const FrameRange& range);

/// Two trajectories of equal length; row i of both is the same frame.
struct TrajectoryPair {
    Trajectory estimate, truth;
};

/// Without a range the files must have equally many rows and the poses stay as they are. With one,
/// truth rows range.begin .. range.end-1 meet the estimate's rows from firstEstimateRow() on; if
/// the range does not start at 0, both are re-based to identity at its first frame. Throws
/// obs::InputError naming the files if there are too few rows or (both files having times) the
/// times of a row differ by more than 10 ms.
TrajectoryPair pairTrajectories(const TrajectoryFile& estimate, const TrajectoryFile& truth,
                                const std::optional<FrameRange>& range);

}  // namespace djpete::evaluation
