/// What the back end did and how long it took.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace djpete::backend {

/// Wall-clock times of one stage, milliseconds.
class StageTimes {
  public:
    void add(double time_ms) { times_ms_.push_back(time_ms); }
    std::size_t count() const { return times_ms_.size(); }
    double total_ms() const;
    /// Smallest time that is not below the fraction `p` (0..1) of all; 0 if there is none.
    double percentile_ms(double p) const;
    double p50_ms() const { return percentile_ms(0.5); }
    double p95_ms() const { return percentile_ms(0.95); }
    double max_ms() const { return percentile_ms(1.0); }

  private:
    std::vector<double> times_ms_;
};

/// Counters are equal in equal runs; times are not.
struct BackendStatistics {
    /// "insert", "associate", "backbone" (on its worker), "objects" (on its worker), "places" (on
    /// its worker), "pose graph", "full adjustment" (on its worker), "merge" (with waiting),
    /// "finish".
    std::map<std::string, StageTimes> stages;
    uint64_t frames = 0, keyframes = 0;
    uint64_t landmarksCreated = 0, landmarksCulled = 0, outlierObservations = 0;
    uint64_t detections = 0, detectionsMatched = 0, headingsFlipped = 0;
    uint64_t objectsCreated = 0, objectsMerged = 0;
    uint64_t objectsRemoved = 0;  ///< that proved to be nothing
    uint64_t backboneSolves = 0, backboneFailures = 0;
    uint64_t jointSolves = 0, jointAccepted = 0;  ///< backbone solves with objects; that counted
    uint64_t viewMatches = 0;                     ///< pairs of views believed
    uint64_t loopsClosed = 0;                     ///< times the map was bent
    uint64_t worldsJoined = 0, landmarksFused = 0, fullAdjustments = 0;
    uint64_t objectSolves = 0;  ///< one per object and job
    uint64_t objectSolveFailures = 0;
    /// Input that was left out, by reason (e.g. "detection with a pose that is not finite").
    std::map<std::string, uint64_t> rejected;
    /// How the last backbone solve ended, and its cost before and after.
    std::string lastBackboneStatus;
    double lastBackboneInitialCost = 0, lastBackboneFinalCost = 0;
};

}  // namespace djpete::backend
