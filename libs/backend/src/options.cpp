/// All INI keys of this room: each option is named once, for reading and for writing.
#include "djpete/obs/options.h"
#include "djpete/backend/joint.h"
#include "djpete/backend/map_keeper.h"
#include "djpete/obs/option_list.h"

namespace djpete::backend {

namespace {

template <class Visitor, class Options>
void visitKeeper(Visitor&& v, Options& o) {
    v.count("latency_keyframes", o.latency_keyframes, 1,
            "A job issued at keyframe k is merged just before keyframe k + this");
    v.count("max_frames_per_keyframe", o.maxFramesPerKeyframe, 1,
            "After this many frames without a keyframe the map adds one without features");
}

template <class Visitor, class Options>
void visitBackbone(Visitor&& v, Options& o) {
    v.flag("enabled", o.enabled, "false: keyframes stay where odometry put them");
    v.count("window_size", o.windowSize, 1, "Keyframes that move in a local adjustment");
    v.count("max_fixed", o.maxFixed, 0, "Keyframes outside the window that hold it in place");
    v.count("final_window_size", o.finalWindowSize, 1,
            "Keyframes that move in the last adjustment");
    v.count("min_shared", o.minShared, 1, "Landmarks shared with the newest to be in its window");
    v.count("first_iterations", o.firstIterations, 1, "With all observations");
    v.count("second_iterations", o.secondIterations, 1, "Without the outliers");
    v.number("huber_scale", o.huberScale, 1e-3,
             "Whitened error from which Huber's kernel flattens");
    v.number("outlier_mono", o.outlierMono, 0, "Squared whitened error of an outlier, 2 dof");
    v.number("outlier_stereo", o.outlierStereo, 0, "Squared whitened error of an outlier, 3 dof");
    v.number("min_disparity_px", o.minDisparity_px, 1e-3, "Below, a feature counts as mono");
    v.number("max_depth_m", o.maxDepth_m, 0, "Landmarks begin with a measured depth up to this");
    v.degrees("min_parallax_deg", o.minParallax_rad,
              "Between two rays to triangulate a mono track");
    v.count("weak_below", o.weakBelow, 0, "With fewer landmarks odometry also holds a keyframe");
    v.number("odometry_sigma_m", o.odometrySigma_m, 1e-6, "Of odometry between keyframes, floor");
    v.number("odometry_sigma_per_metre", o.odometrySigmaPerMetre, 0, "... and share of the way");
    v.degrees("odometry_sigma_deg", o.odometrySigma_rad, "Of odometry's rotation");
    v.number("scan_huber_scale", o.scanHuberScale, 1e-3,
             "Whitened error from which Huber's kernel flattens, motions measured by scans");
}

template <class Visitor, class Options>
void visitLoops(Visitor&& v, Options& o) {
    v.flag("enabled", o.enabled, "false: places are not known again");
    v.count("min_gap_keyframes", o.minGapKeyframes, 1, "The newest ones are no second visit");
    v.count("search_every", o.searchEvery, 1, "Of the keyframes search by their look");
    v.count("candidates", o.candidates, 1, "Old keyframes that look alike, tried per new one");
    v.number("near_distance_m", o.nearDistance_m, 0, "Old keyframes this near are tried first");
    v.degrees("near_angle_deg", o.nearAngle_rad, "... if they look the same way");
    v.count("confirmations", o.confirmations, 1, "Keyframes that must agree on a place");
    v.count("confirm_within", o.confirmWithin, 1, "... out of so many");
    v.number("confirm_m", o.confirm_m, 0, "They agree on the newest camera this well");
    v.degrees("confirm_deg", o.confirm_rad, "... and on its rotation");
    v.number("match_floor_m", o.matchFloor_m, 1e-6, "1-sigma added to a pair of views");
    v.degrees("match_floor_deg", o.matchFloor_rad, "... of rotation");
    v.number("bend_above_m", o.bendAbove_m, 0, "A larger correction bends the whole map");
    v.degrees("bend_above_deg", o.bendAbove_rad, "... or one by so much");
    v.number("drift_floor_m", o.driftFloor_m, 1e-6, "1-sigma of odometry between keyframes");
    v.number("drift_per_metre", o.driftPerMetre, 0, "... and share of the way");
    v.degrees("drift_deg", o.drift_rad, "... of rotation");
    v.count("min_shared", o.minShared, 1, "Landmarks that join two keyframes in the pose graph");
    v.count("max_joined", o.maxJoined, 0, "Others that a keyframe is joined with");
    v.flag("full_adjustment", o.fullAdjustment, "Adjust all keyframes after a loop");
    v.count("full_latency_keyframes", o.fullLatency_keyframes, 1,
            "... and merge the result so many keyframes later");
}

template <class Visitor, class Options>
void visitFilter(Visitor&& v, Options& o) {
    v.number("static_walk", o.staticWalk, 1e-6, "Random walk of a standing object, m per sqrt(s)");
    v.number("acceleration_mps2", o.acceleration_mps2, 1e-6, "1-sigma, of a moving object");
    v.number("yaw_walk", o.yawWalk, 1e-6, "Random walk of the yaw, rad per sqrt(s)");
    v.number("speed_mps", o.speed_mps, 1e-6, "1-sigma of the speed of an object seen once");
    v.number("cross_speed_mps", o.crossSpeed_mps, 1e-6, "... across its length");
}

template <class Visitor, class Options>
void visitAssociation(Visitor&& v, Options& o) {
    v.flag("vehicles_only", o.vehiclesOnly, "Only cars, vans and trucks become objects");
    v.number("min_score", o.minScore, -1e300, "In the detector's own scale");
    v.number("max_range_m", o.maxRange_m, 0, "Detections farther from the camera are left out");
    v.count("max_detections", o.maxDetections, 0, "Per frame; those with the best scores");
    v.number("gate", o.gate, 0, "Squared Mahalanobis distance, position and yaw, 4 dof");
    v.number("max_yaw_distance", o.maxYawDistance, 0, "What yaw can add to it at most");
    v.number("range_sigma", o.rangeSigma, 0, "1-sigma added along the sight, share of the range");
    v.number("occlusion_noise", o.occlusionNoise, 0, "Variance grows by this * covered / visible");
    v.number("position_floor_m", o.positionFloor_m, 0, "1-sigma added to each detection");
    v.degrees("yaw_floor_deg", o.yawFloor_rad, "1-sigma added to each detection");
    v.number("overlap_margin_m", o.overlapMargin_m, 0, "Boxes grown by this must overlap");
    v.number("overlap_weight", o.overlapWeight, 0, "Of (1 - overlap of boxes in 3D) in the cost");
    v.number("image_overlap_weight", o.imageOverlapWeight, 0, "Of (1 - overlap in the image)");
    v.number("size_weight", o.sizeWeight, 0, "Of the difference of sizes");
    v.number("appearance_weight", o.appearanceWeight, 0, "Of how different it looks, 0 to 1");
    v.count("min_detections", o.minDetections, 1, "That make an object");
    v.number("sure_enough", o.sureEnough, 0.01, 0.9999, "... with this probability");
    v.number("detection_rate", o.detectionRate, 0.01, 0.99, "Share of objects in view detected");
    v.number("new_per_frame", o.newPerFrame, 1e-9, "Detections that begin a new object");
    v.number("new_density", o.newDensity, 1e-12, "New objects per m^3 and rad where one was lost");
    v.number("least_clutter", o.leastClutter, 1e-9, "Detections of nothing per frame, at least");
    v.number("score_slope", o.scoreSlope, 0,
             "Log-odds for an object per unit of score; 0: scores say nothing");
    v.number("even_score", o.evenScore, -1e300, "Score at which odds are even");
    v.number("max_score_odds", o.maxScoreOdds, 0, "Log-odds that one score can give");
    v.count("ghost_detections", o.ghostDetections, 0,
            "An object of at most so many that is not there any more goes");
    v.number("heading_flips", o.headingFlips, 1e-4, 0.49,
             "Share of detections that take the rear for the front");
    v.count("max_misses", o.maxMisses, 0, "Frames that a candidate may be missed");
    v.number("max_occlusion_s", o.maxOcclusion_s, 0, "That a moving object may stay unseen");
    v.number("double_overlap", o.doubleOverlap, 0, "With a matched object: a double detection");
    v.number("merge_overlap", o.mergeOverlap, 0, "Of two objects that are one");
    visitFilter(v, o.filter);
}

template <class Visitor, class Options>
void visitObjects(Visitor&& v, Options& o) {
    v.choice("mode", o.mode, {"off", "worker", "joint"},
             "off: no objects; worker: cameras know nothing of them; joint: they help the cameras");
    v.number("robust_scale", o.robustScale, 1e-3, "Whitened error from which an edge loses weight");
    v.count("max_observations", o.maxObservations, 2, "Per standing object while driving");
    v.count("max_observations_moving", o.maxObservationsMoving, 6, "... per moving one");
    v.count("min_observations_to_move", o.minObservationsToMove, 3, "To call an object moving");
    v.number("moving_above", o.movingAbove, 0, "chi^2 won by a moving fit: it moves");
    v.number("static_below", o.staticBelow, 0, "... below this it stands again");
    v.number("min_speed_mps", o.minSpeed_mps, 0, "A moving object is this fast on average");
    v.number("min_travel_m", o.minTravel_m, 0, "... and goes this far");
    v.number("acceleration_sigma_mps2", o.accelerationSigma_mps2, 1e-6,
             "What its speed changes in one second, 1-sigma, along its length");
    v.number("cross_acceleration_sigma_mps2", o.crossAccelerationSigma_mps2, 1e-6,
             "... across and up");
    v.number("turn_acceleration_sigma_radps2", o.turnAccelerationSigma_radps2, 1e-6,
             "... and its turning");
    v.number("cross_speed_sigma_mps", o.crossSpeedSigma_mps, 1e-6, "Sideways and up");
    v.number("tilt_rate_sigma_radps", o.tiltRateSigma_radps, 1e-6, "Of roll and pitch");
    v.number("reverse_speed_mps", o.reverseSpeed_mps, 0, "Faster backwards: heading turned round");
    v.degrees("upright_sigma_deg", o.uprightSigma_rad,
              "Tilt of a standing object against the vehicle, 1-sigma; 0: any");
    v.number("size_sigma", o.sizeSigma, 1e-6, "1-sigma of detected dimensions, as a share");
    v.number("size_prior", o.sizePrior, 0, "Weight of the usual size of its class");
    v.number("stitch_gap_s", o.stitchGap_s, 0, "A lost moving object is looked for so long");
    v.number("stitch_odds", o.stitchOdds, -100, "... and believed with these log-odds");
    v.count("stitch_views", o.stitchViews, 2, "... with so many observations before and after");
    v.number("camera_drift", o.cameraDrift, 0,
             "Share of its way by which a camera may err (views of standing objects)");
    v.count("threads", o.threads, 0, 256, "For many objects; 0: all cores; same results");
    v.flag("use_points", o.usePoints, "Scans refine poses and sizes of objects");
    v.count("point_views", o.pointViews, 1, "Views of a standing object that give points");
}

template <class Visitor, class Options>
void visitJoint(Visitor&& v, Options& o) {
    v.count("few_landmarks", o.fewLandmarks, 0, "Objects join where a camera sees fewer than this");
    v.count("min_observations", o.minObservations, 2, "That an object needs to join");
    v.number("max_sigma_m", o.maxSigma_m, 0, "... and how well its position is known, worst axis");
    v.count("min_cameras", o.minCameras, 2, "... and how many cameras of the problem see it");
    v.count("max_landmarks_in_box", o.maxLandmarksInBox, 0, "With more it stays out");
    v.number("robust_scale", o.robustScale, 1e-3, "Whitened error from which an edge loses weight");
    v.number("correlation", o.correlation, 0, 1,
             "Of the errors of detections of one object that are");
    v.count("correlated_frames", o.correlatedFrames, 0, "... at most so many frames apart");
    v.number("max_share", o.maxShare, 0, "Of the objects in a camera's position, to the points'");
    v.number("max_cost_rise", o.maxCostRise, 0, "Share by which the points' cost may rise");
    v.number("max_mean_chi2", o.maxMeanChi2, 0, "Of the edges, per degree of freedom");
}

}  // namespace

#define DJPETE_BACKEND_OPTIONS(Options, visit)                                    \
    void Options::loadFromConfigFile(const mrpt::config::CConfigFileBase& source, \
                                     const std::string& section) {                \
        visit(obs::OptionLoader(source, section), *this);                         \
    }                                                                             \
    void Options::saveToConfigFile(mrpt::config::CConfigFileBase& target,         \
                                   const std::string& section) const {            \
        visit(obs::OptionSaver(target, section), *this);                          \
    }
DJPETE_BACKEND_OPTIONS(KeeperOptions, visitKeeper)
DJPETE_BACKEND_OPTIONS(BackboneOptions, visitBackbone)
DJPETE_BACKEND_OPTIONS(LoopOptions, visitLoops)
DJPETE_BACKEND_OPTIONS(AssociationOptions, visitAssociation)
DJPETE_BACKEND_OPTIONS(ObjectOptions, visitObjects)
DJPETE_BACKEND_OPTIONS(JointOptions, visitJoint)
#undef DJPETE_BACKEND_OPTIONS

void BackendOptions::load(const mrpt::config::CConfigFileBase& config, const std::string& origin) {
    obs::loadOptions(keeper, config, "map_keeper", origin);
    obs::loadOptions(backbone, config, "backbone", origin);
    obs::loadOptions(recognition.loops, config, "loops", origin);
    obs::loadOptions(recognition.database, config, "places", origin);
    obs::loadOptions(recognition.match, config, "place_match", origin);
    obs::loadOptions(association, config, "association", origin);
    obs::loadOptions(objects, config, "objects", origin);
    obs::loadOptions(joint, config, "joint", origin);
}

void BackendOptions::save(mrpt::config::CConfigFileBase& config) const {
    keeper.saveToConfigFile(config, "map_keeper");
    backbone.saveToConfigFile(config, "backbone");
    recognition.loops.saveToConfigFile(config, "loops");
    recognition.database.saveToConfigFile(config, "places");
    recognition.match.saveToConfigFile(config, "place_match");
    association.saveToConfigFile(config, "association");
    objects.saveToConfigFile(config, "objects");
    joint.saveToConfigFile(config, "joint");
}

}  // namespace djpete::backend
