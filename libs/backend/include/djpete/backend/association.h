/// Which detection belongs to which object, over time.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "djpete/backend/object_filter.h"
#include "djpete/map/entities.h"

namespace djpete::backend {

struct AssociationOptions : public mrpt::config::CLoadableOptions {
    /// Only cars, vans and trucks become objects.
    bool vehiclesOnly = true;
    /// Detections with a lower score (in the detector's own scale) are left out.
    double minScore = -1e9;
    /// Detections farther from the camera are left out.
    double maxRange_m = 120;
    /// Of more detections in a frame, those with the best scores are used.
    unsigned maxDetections = 200;
    /// Squared Mahalanobis distance (position and yaw, 4 degrees of freedom) up to which a
    /// detection may belong to an object (99.9 %).
    double gate = 18.5;
    /// What a yaw error can add to that distance at most: boxes may be a quarter turn off.
    double maxYawDistance = 9.0;
    /// What a detection's covariance leaves out: 1-sigma along the line of sight as a share of the
    /// range, and how much its variance grows where nearer objects cover its image box.
    double rangeSigma = 0.002, occlusionNoise = 0.3;
    /// 1-sigma added to what a detection says of itself: odometry, bias with the view.
    double positionFloor_m = 0.15, yawFloor_rad = 0.09;
    /// Boxes grown by this much must overlap, once the object's motion is known.
    double overlapMargin_m = 0.5;
    /// Weight of (1 - overlap) in the cost: boxes in 3D, and boxes in the image.
    double overlapWeight = 4.0, imageOverlapWeight = 2.0;
    /// Weight of the difference of sizes, sum of |ln ratio|.
    double sizeWeight = 1.0;
    /// Weight of how different it looks, 0..1 (obs::appearanceDistance).
    double appearanceWeight = 4.0;
    /// Detections that make an object; in at least half of the frames since the first, and with
    /// this probability by all evidence.
    unsigned minDetections = 3;
    double sureEnough = 0.95;
    /// Probability that an object in view is detected; detections per frame that begin a new
    /// object; detections per frame that are of nothing, at least (more are noticed by themselves).
    double detectionRate = 0.8, newPerFrame = 0.1, leastClutter = 0.5;
    /// How densely new objects come into view where one was lost, per m^3 and rad of heading.
    double newDensity = 5e-3;
    /// What a score says: the logarithm of the odds for an object is scoreSlope * (score -
    /// evenScore), at most +-maxScoreOdds. 0: scores say nothing.
    double scoreSlope = 0, evenScore = 0, maxScoreOdds = 3;
    /// An object with at most so many detections that is surely not there any more never was one.
    unsigned ghostDetections = 8;
    /// Share of detections whose front is where the rear is.
    double headingFlips = 0.1;
    /// Frames (with detections) that a candidate may be missed before it is dropped.
    unsigned maxMisses = 3;
    /// Time that a moving object may stay unseen. A static one is remembered for good.
    double maxOcclusion_s = 4.0;
    /// A detection that overlaps an object seen in the same frame by more is its double.
    double doubleOverlap = 0.2;
    /// Two objects whose boxes overlap by more are one.
    double mergeOverlap = 0.3;
    FilterOptions filter;  ///< keys of the same section

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// A thing that detections were seen of: a candidate until it is confirmed, then an object.
struct TrackedThing {
    uint64_t key = 0;
    std::optional<map::ObjectId> object;  ///< set by the owner once confirmed
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    geometry::Vec3 size_m{0, 0, 0};
    ObjectFilter filter;
    unsigned hits = 0, frames = 0, misses = 0;  ///< frames: with detections, since the first hit
    double existence = 0;                       ///< log-odds that it is there at all
    double farthestHit_m = 0;                   ///< from the camera
    double headingOdds = 0;     ///< log-odds that its heading is not the opposite one
    bool headingWrong = false;  ///< to be turned round by the owner
    double lastSeen_s = 0, lastPredicted_s = 0;
    std::optional<obs::ImageBox> lastBox;
    std::optional<obs::Appearance> looks;  ///< at the last hit that saw it well
    map::KeyframeId anchor;                ///< reference keyframe of the last hit
    geometry::SE3 T_world_anchor;          ///< where that was at the last hit
    /// Observations not yet handed on; emptied by the owner when the thing is confirmed.
    std::vector<map::ObjectObservation> waiting;
};

struct Seen;

/// Keeps the things and matches each frame's detections to them. Deterministic.
class ObjectAssociator {
  public:
    explicit ObjectAssociator(AssociationOptions options) : options_(std::move(options)) {}

    /// One frame. `detections` must be checked (finite, sized, information positive), poses in the
    /// frame of the camera. Returns the keys of the things that were hit; their newest observation
    /// is the last of `waiting`, with the heading turned to the thing's.
    struct Frame {
        map::FrameId frame;
        double time_s = 0;
        map::KeyframeId anchor;
        geometry::SE3 T_world_anchor, T_world_cam;
        std::optional<geometry::StereoCamera> camera;  ///< to tell what is in view
    };
    std::vector<uint64_t> associate(const Frame& frame,
                                    std::vector<map::ObjectObservation> detections);

    /// Moves every thing along with its anchor keyframe, after cameras were corrected.
    void follow(const std::function<geometry::SE3(map::KeyframeId)>& T_world_anchor);
    /// Turns the heading of a thing by pi.
    void turnRound(uint64_t key);
    void remove(uint64_t key) { things_.erase(key); }

    /// Things that are objects of the map but, as evidence has it since, of nothing.
    std::vector<uint64_t> ghosts() const;

    const std::map<uint64_t, TrackedThing>& things() const { return things_; }
    TrackedThing& thing(uint64_t key) { return things_.at(key); }
    const AssociationOptions& options() const { return options_; }
    /// True if seen often enough to be an object of the map.
    bool confirmed(const TrackedThing& thing) const;
    /// Detections left out because they doubled one that was matched.
    uint64_t doubles() const { return doubles_; }

  private:
    /// Of the detections not used, those that double nothing. Returns how many.
    double beginNew(const Frame& frame, std::vector<Seen>& seen, const std::vector<bool>& used,
                    std::set<uint64_t>& hits);
    void forget(double time_s);
    /// Detections of nothing, per m^3 rad.
    double clutterDensity() const;
    double scoreOdds(const map::ObjectObservation& o) const;

    AssociationOptions options_;
    std::map<uint64_t, TrackedThing> things_;
    uint64_t nextKey_ = 0, doubles_ = 0;
    double clutter_ = 0;  ///< per frame, detections of what is no object (yet)
    uint64_t clutterFrames_ = 0;
};

}  // namespace djpete::backend
