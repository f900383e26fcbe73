#include "depth_measurement.h"

#include <algorithm>

namespace djpete::frontend {

namespace {

void fuse(std::optional<InverseDepth>& into, const InverseDepth& other) {
    if (!into) {
        into = other;
        return;
    }
    const double w = into->variance / (into->variance + other.variance);
    into->value += w * (other.value - into->value);
    into->variance *= 1 - w;
}

}  // namespace

void measureStereo(FeatureTrack& track, const DepthSensors& sensors,
                   std::optional<double> guessInverseDepth) {
    if (!sensors.stereo) return;
    const double fb = sensors.camera.fx * sensors.camera.baseline_m;
    std::optional<double> guess_px;
    if (guessInverseDepth) guess_px = fb * *guessInverseDepth;
    const auto match = sensors.stereo->match(track.now.px, guess_px);
    if (!match) return;
    track.uRight_px = match->uRight_px;
    track.disparitySigma_px = match->disparitySigma_px;
    track.rowDifference_px = match->rowDifference_px;
    if (track.framesFollowed == 0) track.inverseDepthPerRow = match->disparityPerRow / fb;
    const double disparity = static_cast<double>(track.now.px.x) - match->uRight_px;
    const double sigma = match->disparitySigma_px / fb;
    const InverseDepth byStereo{disparity / fb, sigma * sigma};
    const auto& byLidar = track.now.inverseDepth;
    track.now.stereoShare =
        byLidar ? byLidar->variance / (byLidar->variance + byStereo.variance) : 1.0;
    fuse(track.now.inverseDepth, byStereo);
}

void measureLidar(FeatureTrack& track, const DepthSensors& sensors) {
    if (!sensors.scan) return;
    const auto depth = sensors.scan->depthAt(track.now.px.x, track.now.px.y);
    if (!depth) return;
    track.lidarDepth_m = depth->depth_m;
    track.lidarSigma_m = depth->sigma_m;
    const double z = depth->depth_m;
    const double sigma = depth->sigma_m / (z * z);
    const InverseDepth byLidar{1.0 / z, sigma * sigma};
    const auto& byStereo = track.now.inverseDepth;
    if (byStereo)
        track.now.stereoShare = byLidar.variance / (byLidar.variance + byStereo->variance);
    fuse(track.now.inverseDepth, byLidar);
}

}  // namespace djpete::frontend
