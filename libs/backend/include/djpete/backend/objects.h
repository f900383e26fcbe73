/// Object poses and motion against camera-object edges, all cameras fixed.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <map>
#include <optional>
#include <vector>

#include "djpete/map/slam_map.h"

namespace djpete::backend {

enum class ObjectMode {
    Off,     ///< detections are not used for the map
    Worker,  ///< objects are solved with the cameras fixed: cameras are as without objects
    Joint    ///< standing objects also help the cameras where features are few (joint.h)
};

struct ObjectOptions : public mrpt::config::CLoadableOptions {
    ObjectMode mode = ObjectMode::Worker;
    /// Whitened error of a camera-object edge (6 degrees of freedom) from which it loses weight.
    double robustScale = 4.0;
    /// Observations used per object while driving (the newest of a moving object, an even choice
    /// of a static one); the last solve takes all.
    unsigned maxObservations = 60, maxObservationsMoving = 24;
    /// Observations from which an object may be called moving.
    unsigned minObservationsToMove = 3;
    /// Fall of the robust cost (in chi^2) from a standing to a moving fit at which a static object
    /// becomes moving, and below which a moving one becomes static.
    double movingAbove = 30, staticBelow = 12;
    /// A moving object is at least this fast on average and went at least this far; half of it
    /// keeps it moving.
    double minSpeed_mps = 0.8, minTravel_m = 1.0;
    /// White noise on acceleration: what the speed along the object's length, across and up, and
    /// its turning change in one second, 1-sigma (m/s, rad/s per sqrt(s)).
    double accelerationSigma_mps2 = 2.0, crossAccelerationSigma_mps2 = 0.3;
    double turnAccelerationSigma_radps2 = 0.4;
    /// 1-sigma of speed sideways and up (m/s), and of roll and pitch rates (rad/s): wheels roll
    /// forward.
    double crossSpeedSigma_mps = 0.3, tiltRateSigma_radps = 0.05;
    /// A moving object that goes backwards faster than this has its heading turned round.
    double reverseSpeed_mps = 2.0;
    /// 1-sigma of the tilt between a standing object's height and the vehicle's; 0: no prior.
    double uprightSigma_rad = 0.05;
    /// 1-sigma of a detection's dimensions, as a share; and how strongly the usual size of the
    /// class is believed (times its spread; 0: not at all).
    double sizeSigma = 0.08, sizePrior = 1.0;
    /// A lost object and one seen anew are one if a motion joins them over at most so long a gap,
    /// with these log-odds; both must have so many observations. 0 s: never.
    double stitchGap_s = 8, stitchOdds = 2;
    unsigned stitchViews = 4;
    /// Cameras err by this share of their way (ObjectTrack::views); 0: not looked at.
    double cameraDrift = 0.03;
    /// Objects are solved in this many threads; 0: all cores. No influence on results.
    unsigned threads = 0;
    /// LiDAR points of the views refine poses and sizes, where there are scans.
    bool usePoints = true;
    /// Views of a standing object whose points are used, spread evenly over all.
    unsigned pointViews = 20;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// Objects to solve, each on its own.
struct ObjectProblem {
    struct Edge {
        map::FrameId frame;
        double time_s = 0;  ///< since the first frame of the drive
        map::KeyframeId anchor;
        geometry::SE3 T_world_anchor, T_world_cam;  ///< constants
        geometry::SE3 T_cam_obj;                    ///< measured
        geometry::Mat6 information;
        geometry::Vec3 size_m{0, 0, 0};
        geometry::Vec3 up_world{0, 0, 1};  ///< of the vehicle
        /// The map's estimate so far.
        std::optional<geometry::SE3> T_world_obj;
        geometry::Vec6 twist = geometry::Vec6::Zero();
        obs::ObjectPointsPtr points;  ///< frame cam; may be null
    };
    struct Object {
        map::ObjectId id;
        obs::ObjectClass objectClass = obs::ObjectClass::Car;
        uint64_t epoch = 0;       ///< goes back in the update; says which observations were meant
        bool moving = false;      ///< as judged so far
        std::vector<Edge> edges;  ///< in order of time
    };
    std::vector<Object> objects;
    bool all = false;  ///< use every edge, whatever maxObservations says
};

struct ObjectUpdate {
    struct Object {
        map::ObjectId id;
        uint64_t epoch = 0;
        bool solved = false;  ///< false: nothing else here is set
        bool moving = false;
        bool turnRound = false;  ///< its heading is opposite to where it goes
        geometry::Vec3 size_m{0, 0, 0};
        std::vector<map::ObjectState> states;         ///< at the edges used; static: at all edges
        std::map<map::FrameId, geometry::SE3> views;  ///< see map::ObjectTrack; with all edges only
    };
    std::vector<Object> objects;
    double time_ms = 0;
};

/// How much better a moving than a standing fit explains an object's positions.
struct MotionEvidence {
    double chi2Drop = 0;  ///< fall of twice the robust cost
    double speed_mps = 0, travel_m = 0;
    double timeSpan_s = 0;
};
MotionEvidence motionEvidence(const std::vector<ObjectProblem::Edge>& edges,
                              const ObjectOptions& options);

/// Per object: static or moving by evidence, then its pose (or one pose per edge with a
/// constant-velocity motion between) with covariance. Objects are independent. Pure: equal problems
/// give equal updates.
ObjectUpdate solve(const ObjectProblem& problem, const ObjectOptions& options);

}  // namespace djpete::backend
