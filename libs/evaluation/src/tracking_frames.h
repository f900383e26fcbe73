/// Labels and results of a drive made ready for many passes. Private to the room.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "djpete/evaluation/tracking_errors.h"

namespace djpete::evaluation {

/// A labelled car or van.
struct CountedLabel {
    std::size_t track = 0;  ///< tracks count from 0, in order of their ids
    bool ignored = false;
};

/// A tracked car or van.
struct CountedResult {
    std::size_t track = 0;
    double score = 0;        ///< mean of its track
    bool ignorable = false;  ///< not false even if unmatched
};

/// One frame. Labels and results are positions in the drive's lists.
struct TrackingFrame {
    std::vector<std::size_t> labels, results;
    Eigen::MatrixXd overlap;  ///< labels x results
};

struct TrackingDrive {
    std::vector<CountedLabel> labels;
    std::vector<CountedResult> results;
    std::vector<TrackingFrame> frames;  ///< in order; only those with a box
    std::vector<std::vector<std::size_t>>
        labelTracks;  ///< labels of each track, in order of frames
    std::size_t resultTracks = 0;
};

TrackingDrive prepareDrive(const TrackingPair& pair, const TrackingCriteria& criteria);

}  // namespace djpete::evaluation
