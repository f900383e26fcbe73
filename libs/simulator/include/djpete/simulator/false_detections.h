/// What a detector sees where nothing is.
#pragma once

#include "djpete/simulator/labels.h"

namespace djpete::simulator {

/// False detections of a frame: boxes of the size of cars that stand on the ground at random places
/// in view, with random headings. `trueRows` rows are right; so many false ones are given that
/// they are the share `noise.falseShare` of all rows on average. One in six stays at its place in
/// the world for two or three frames, measured anew in each. Scores are lower than those of true
/// detections on average, but overlap them.
///
/// Pure: the same world, frame, camera and options give the same rows. Track ids are 0.
std::vector<Detection> makeFalseDetections(const World& world, uint64_t frame,
                                           const geometry::StereoCamera& camera,
                                           const geometry::SE3& T_vehicle_cam, std::size_t trueRows,
                                           const DetectorNoise& noise, double maxRange_m);

}  // namespace djpete::simulator
