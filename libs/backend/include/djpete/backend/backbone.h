/// Local bundle adjustment: camera poses and points; standing objects where joint.h adds them.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <optional>
#include <utility>
#include <vector>

#include "djpete/map/slam_map.h"
#include "djpete/solver/solve.h"

namespace djpete::backend {

struct BackboneOptions : public mrpt::config::CLoadableOptions {
    /// Off: keyframes stay where odometry put them.
    bool enabled = true;
    /// Keyframes that move: the newest and those that share most landmarks with it.
    unsigned windowSize = 10;
    /// Keyframes outside the window that hold the landmarks in place; the rest is left out.
    unsigned maxFixed = 15;
    /// Window of the last solve, when the drive is over.
    unsigned finalWindowSize = 150;
    /// Landmarks that a keyframe must share with the newest to be in its window.
    unsigned minShared = 10;
    /// Iterations with all observations, and after the outliers went out.
    unsigned firstIterations = 6, secondIterations = 8;
    /// Whitened error from which Huber's kernel flattens.
    double huberScale = 2.0;
    /// Squared whitened errors from which an observation is an outlier (95 % of chi^2, 2 and 3
    /// degrees of freedom).
    double outlierMono = 5.99, outlierStereo = 7.81;
    /// Disparities below tell nothing of depth: the feature counts as mono.
    double minDisparity_px = 1.0;
    /// Landmarks begin with a depth up to this many metres only.
    double maxDepth_m = 300;
    /// Angle between two rays from which a mono track becomes a landmark.
    double minParallax_rad = 0.017;
    /// A keyframe with fewer landmarks is also held by odometry to its neighbours.
    unsigned weakBelow = 30;
    /// 1-sigma of odometry between neighbours, for those: floor and share of the way; rotation.
    double odometrySigma_m = 0.05, odometrySigmaPerMetre = 0.02, odometrySigma_rad = 0.01;
    /// Whitened error (6 dof) from which Huber's kernel flattens for motions that scans measured.
    double scanHuberScale = 4.0;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// A part of the map as values; indices point into the vectors.
struct BackboneProblem {
    struct Camera {
        map::KeyframeId id;
        geometry::StereoCamera camera;
        geometry::SE3 T_world_cam;
        bool fixed = false;
    };
    struct Point {
        map::LandmarkId id;
        geometry::Vec3 p_world;
    };
    struct Observation {
        std::size_t camera, point;
        obs::KeyframeFeature feature;
    };
    /// Odometry from camera a to camera b.
    struct Odometry {
        std::size_t a, b;
        geometry::SE3 T_a_b;
    };
    std::vector<Camera> cameras;
    std::vector<Point> points;
    std::vector<Observation> observations;
    /// Camera b as seen from camera a, measured by matching scans.
    struct Scan {
        std::size_t a, b;
        geometry::SE3 T_a_b;
        geometry::Mat6 information;  ///< in the frame of b
    };
    std::vector<Odometry> odometry;
    std::vector<Scan> scans;
    struct Object {
        map::ObjectId id;
        geometry::SE3 T_world_obj;
    };
    /// An object as measured from a keyframe's camera.
    struct ObjectEdge {
        std::optional<std::size_t> camera;  ///< none: a constant one at T_world_cam
        std::size_t object;
        geometry::SE3 T_world_cam, T_cam_obj;
        geometry::Mat6 information;  ///< in the frame of the object
    };
    std::vector<Object> objects;  ///< none unless addObjects found some
    std::vector<ObjectEdge> objectEdges;
};

struct JointOptions;

/// What became of the objects of a problem.
enum class JointOutcome {
    None,      ///< there were none
    Accepted,  ///< the cameras are those of the problem with objects
    Refused    ///< the cameras are those of the problem without objects
};

struct BackboneUpdate {
    std::vector<std::pair<map::KeyframeId, geometry::SE3>> cameras;  ///< the free ones
    std::vector<std::pair<map::LandmarkId, geometry::Vec3>> points;  ///< those still supported
    std::vector<std::pair<map::LandmarkId, map::KeyframeId>> outliers;
    std::vector<map::LandmarkId> culled;  ///< left with fewer than two observations
    solver::Report report;                ///< of the second round
    JointOutcome joint = JointOutcome::None;
    double time_ms = 0;
};

/// The window around the newest keyframe of `map` with `windowSize` free keyframes; empty if there
/// is nothing to adjust. Only keyframes of the newest one's world take part. The map's first
/// keyframe, all below `firstFree`, and at least one of the window, are fixed.
BackboneProblem backboneProblem(const map::SlamMap& map, const BackboneOptions& options,
                                unsigned windowSize, map::KeyframeId firstFree = {});

/// Two rounds of bundle adjustment with outlier removal between them. Pure: equal problems give
/// equal updates. A problem that cannot be solved gives an update without cameras.
BackboneUpdate solve(const BackboneProblem& problem, const BackboneOptions& options);
/// The same, then a round with the problem's objects, whose result counts if it passes the gate.
/// The objects' own poses are the object worker's business.
BackboneUpdate solve(const BackboneProblem& problem, const BackboneOptions& options,
                     const JointOptions& joint);

}  // namespace djpete::backend
