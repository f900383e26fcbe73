/// Loop closing and relocalisation: when a keyframe shows a place that the map knows already.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <set>
#include <utility>
#include <vector>

#include "djpete/map/slam_map.h"
#include "djpete/places/place_database.h"
#include "djpete/places/view_match.h"

namespace djpete::backend {

struct LoopOptions : public mrpt::config::CLoadableOptions {
    /// Off: places are not known again.
    bool enabled = true;
    /// The newest keyframes are never a second visit.
    unsigned minGapKeyframes = 25;
    /// Of the keyframes that know where they are, every so many searches all others by its look.
    /// One that does not know, or that could confirm a claim, always does.
    unsigned searchEvery = 2;
    /// Old keyframes tried per new one, those that look most alike.
    unsigned candidates = 3;
    /// Where the map says that an old keyframe is this near and looks the same way, it is tried
    /// first, with its predicted view.
    double nearDistance_m = 6, nearAngle_rad = 0.5;
    /// A place known by its look alone is believed when this many keyframes within
    /// `confirmWithin` agree.
    unsigned confirmations = 2, confirmWithin = 6;
    /// They agree if they correct the newest keyframe alike.
    double confirm_m = 1.0, confirm_rad = 0.035;
    /// 1-sigma added to what a pair of views says of their motion.
    double matchFloor_m = 0.02, matchFloor_rad = 0.001;
    /// A correction beyond bends the whole map (pose graph); below, local adjustment takes it.
    double bendAbove_m = 0.15, bendAbove_rad = 0.005;
    /// Drift of odometry between neighbouring keyframes, 1-sigma: floor, share of the way,
    /// rotation.
    double driftFloor_m = 0.005, driftPerMetre = 0.005, drift_rad = 0.0005;
    /// Landmarks that two keyframes must share to be joined in the pose graph, and how many others
    /// a keyframe is joined with.
    unsigned minShared = 20, maxJoined = 5;
    /// After a loop all keyframes are adjusted in the background; the result is merged this many
    /// keyframes later.
    bool fullAdjustment = true;
    unsigned fullLatency_keyframes = 30;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// A keyframe that asks where it is.
struct LoopJob {
    struct Near {
        map::KeyframeId id;
        geometry::SE3 T_near_view;  ///< as the map has it
    };
    places::PlaceView view;
    std::vector<Near> near;
    std::set<map::KeyframeId> excluded;  ///< recent ones
    bool search = true;                  ///< by look, if nothing near matches
};

struct LoopUpdate {
    struct Match {
        map::KeyframeId other;
        places::ViewMatch match;  ///< a: other, b: the asking keyframe
        bool near = false;        ///< found where the map said
    };
    map::KeyframeId id;
    std::vector<Match> matches;
    double time_ms = 0;
};

/// All options of place recognition; sections [loops], [places], [place_match].
struct RecognitionOptions {
    LoopOptions loops;
    places::DatabaseOptions database;
    places::MatchOptions match;
};

/// Knows the views of all keyframes. Equal calls in equal order give equal updates.
class LoopFinder {
  public:
    explicit LoopFinder(const RecognitionOptions& options)
        : options_(options), database_(options.database) {}
    /// A keyframe of a map that was loaded.
    void add(places::PlaceView view) { database_.add(std::move(view)); }
    /// Looks for the job's view among the older ones, then keeps it.
    LoopUpdate find(const LoopJob& job);

  private:
    RecognitionOptions options_;
    places::PlaceDatabase database_;
};

/// What keyframe `id` of `map` asks, with its view. `claimed`: an older keyframe's claim waits to
/// be confirmed.
LoopJob loopJob(const map::SlamMap& map, map::KeyframeId id, bool claimed,
                const LoopOptions& options);

}  // namespace djpete::backend
