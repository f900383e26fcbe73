/// Objects in the backbone's adjustment: cameras, points and standing objects as one problem.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <set>

#include "djpete/backend/backbone.h"

namespace djpete::backend {

struct JointOptions : public mrpt::config::CLoadableOptions {
    /// Objects join where a free camera sees fewer landmarks than this: good features need none.
    unsigned fewLandmarks = 60;
    /// An object joins with this many observations at least, if its position is this well known
    /// (1-sigma, its worst axis), and if this many cameras of the problem see it.
    unsigned minObservations = 8;
    double maxSigma_m = 0.25;
    unsigned minCameras = 2;
    /// With this many landmarks within its box an object stays out: they have told of it already.
    unsigned maxLandmarksInBox = 3;
    /// Whitened error (6 degrees of freedom) at which Cauchy's kernel takes weight away.
    double robustScale = 4.0;
    /// Correlation between the errors of detections of one object that are at most so many frames
    /// apart: one with n - 1 such neighbours has 1 / (1 + (n - 1) * correlation) of its
    /// information.
    double correlation = 0.3;
    unsigned correlatedFrames = 2;
    /// What the objects tell of a camera's position is at most this share of what its points tell.
    double maxShare = 0.3;
    /// The result counts if the robust cost of everything but the objects rises by no more than
    /// this share, and if the edges' mean squared error is at most this (1: as their information
    /// says).
    double maxCostRise = 0.05, maxMeanChi2 = 1.8;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// Adds standing, well known objects of `solved` (those that the object worker has solved) to a
/// problem of `map`'s newest world, with an edge per detection. A detection between keyframes hangs
/// on its reference keyframe by odometry. Cameras that are not of the problem are constants. Adds
/// nothing where every free camera sees enough landmarks.
void addObjects(const map::SlamMap& map, const std::set<map::ObjectId>& solved,
                const JointOptions& options, BackboneProblem& problem);

}  // namespace djpete::backend
