/// The map's loops: which matches of views are believed, and what they do to the map.
#pragma once

#include <deque>
#include <vector>

#include "djpete/backend/loops.h"
#include "djpete/backend/pose_graph.h"
#include "djpete/backend/statistics.h"
#include "landmark_builder.h"

namespace djpete::backend {

/// Keeps matches that wait for another one to agree, and what was believed so far.
class LoopKeeper {
  public:
    explicit LoopKeeper(LoopOptions options) : options_(std::move(options)) {}

    struct Outcome {
        bool accepted = false;
        bool moved = false;  ///< older keyframes were moved, or two worlds became one
    };
    /// Keyframes below `firstFree` are never moved.
    Outcome merge(map::SlamMap& map, const LoopUpdate& update, map::KeyframeId firstFree,
                  LandmarkBuilder& landmarks, BackendStatistics& statistics);
    /// A claim waits for another keyframe to agree.
    bool claimed() const { return !waiting_.empty(); }
    const std::vector<map::LoopRecord>& records() const { return records_; }

  private:
    struct Claim {
        map::KeyframeId older, newer;
        places::ViewMatch match;
        bool near = false;
    };
    /// The claims to believe now, the newest last; the others wait.
    std::vector<Claim> believed(const map::SlamMap& map, const LoopUpdate& update);
    bool agree(const map::SlamMap& map, const Claim& a, const Claim& b) const;
    LoopEdge edgeOf(const Claim& claim) const;
    map::LoopRecord recordOf(const map::SlamMap& map, const Claim& claim) const;
    void bend(map::SlamMap& map, const std::vector<LoopEdge>& edges, map::KeyframeId firstFree,
              BackendStatistics& statistics);

    LoopOptions options_;
    std::deque<Claim> waiting_;
    std::vector<map::LoopRecord> records_;
};

}  // namespace djpete::backend
