/// The objects of the map: from detections to tracks to problems and back.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "djpete/backend/association.h"
#include "djpete/backend/objects.h"
#include "djpete/backend/statistics.h"

namespace djpete::backend {

/// Keeps the associator and what is due for a solve. Touches objects of the map only.
class ObjectKeeper {
  public:
    ObjectKeeper(AssociationOptions association, ObjectOptions options)
        : associator_(std::move(association)), options_(std::move(options)) {}

    /// Objects of an earlier drive are as good as solved ones.
    void adopt(const map::SlamMap& map);
    /// Detections of `frame`, which the map must know.
    void observe(map::SlamMap& map, map::FrameId frame,
                 std::vector<map::ObjectObservation> detections, BackendStatistics& statistics);
    /// All objects are solved once more, a few with each problem(): their cameras have moved.
    void solveAgain(const map::SlamMap& map);
    /// Objects with new observations since the last call; with `all`, every object and every edge.
    ObjectProblem problem(const map::SlamMap& map, bool all);
    void merge(map::SlamMap& map, const ObjectUpdate& update, BackendStatistics& statistics);
    /// Objects whose boxes overlap become one. True if there were any.
    bool mergeDoubles(map::SlamMap& map, BackendStatistics& statistics);
    /// Objects that became part of another one, and of which.
    const std::map<map::ObjectId, map::ObjectId>& joined() const { return joined_; }
    /// Objects that were solved at least once; some may be gone.
    const std::set<map::ObjectId>& solved() const { return solved_; }
    /// After keyframes were corrected: everything moves along with its anchor.
    void follow(const map::SlamMap& map);

  private:
    void confirm(map::SlamMap& map, TrackedThing& thing, BackendStatistics& statistics);
    void remove(map::SlamMap& map, map::ObjectId object);
    void turnRound(map::SlamMap& map, map::ObjectId object, BackendStatistics& statistics);
    void join(map::SlamMap& map, map::ObjectId kept, map::ObjectId gone);
    std::optional<uint64_t> keyOf(map::ObjectId object) const;

    ObjectAssociator associator_;
    ObjectOptions options_;
    std::map<map::ObjectId, uint64_t> epochs_;  // rises when observations are turned or joined
    std::set<map::ObjectId> again_;             // to be solved once more, when there is time
    std::set<map::ObjectId> due_, solved_;      // solved: at least once
    std::map<map::ObjectId, map::ObjectId> joined_;
    std::set<map::ObjectId> changed_;  // by solves since doubles were looked for
};

}  // namespace djpete::backend
