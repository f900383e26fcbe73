/// Hand-made tracks for the tests of tracking.
#pragma once

#include <string>
#include <vector>

#include "djpete/evaluation/tracking_errors.h"
#include "evaluation_worlds.h"

namespace evaluation_test {

using djpete::evaluation::TrackingBox;
using djpete::evaluation::TrackingPair;

/// A car of 4 x 2 x 1.5 m, its length along the camera's x, on the ground 10 m ahead; 100 px high
/// in the image. Moved by d along x, two of them overlap by (4 - d) / (4 + d).
inline TrackingBox carAt(std::size_t frame, int64_t track, double x = 0, double z = 10) {
    TrackingBox box;
    box.frame = frame;
    box.trackId = track;
    box.size_m = {4, 2, 1.5};
    box.T_cam_obj = djpete::evaluation::labelPose({x, 1.6, z}, 1.5, 0);
    box.image = {0, 0, 100, 100};
    return box;
}

inline TrackingBox scored(TrackingBox box, double score) {
    box.score = score;
    return box;
}

/// Labels of track 1 in frames 0 .. frames-1, and results of track `resultIds[frame]` on them; none
/// where it is -1.
inline TrackingPair drive(std::size_t frames, const std::vector<int64_t>& resultIds) {
    TrackingPair pair;
    pair.labels.name = "0000";
    for (std::size_t f = 0; f < frames; ++f) {
        pair.labels.boxes.push_back(carAt(f, 1));
        if (resultIds.at(f) >= 0)
            pair.results.boxes.push_back(scored(carAt(f, resultIds[f]), 0.75));
    }
    return pair;
}

}  // namespace evaluation_test
