/// The whole map as poses and the motions between them: bent when a loop closes.
#pragma once

#include <utility>
#include <vector>

#include "djpete/backend/loops.h"
#include "djpete/map/slam_map.h"
#include "djpete/solver/solve.h"

namespace djpete::backend {

/// What two views of one place say: camera b in camera a.
struct LoopEdge {
    map::KeyframeId a, b;  ///< a is the older
    geometry::SE3 T_a_b;
    geometry::Mat6 information;  ///< frame b
};

struct PoseGraphProblem {
    struct Pose {
        map::KeyframeId id;
        geometry::SE3 T_world_cam;
        bool fixed = false;
    };
    struct Edge {
        std::size_t a, b;
        geometry::SE3 T_a_b;
        geometry::Mat6 information;
        bool robust = false;
    };
    std::vector<Pose> poses;
    std::vector<Edge> edges;
};

struct PoseGraphUpdate {
    std::vector<std::pair<map::KeyframeId, geometry::SE3>> poses;  ///< the free ones
    solver::Report report;
    double time_ms = 0;
};

/// All keyframes of the world of `loops`: neighbours of a segment, keyframes that share landmarks
/// (both as the map has them now) and `loops` as measured. The world's first keyframe is fixed,
/// and so are all with an id below `firstFree`.
PoseGraphProblem poseGraphProblem(const map::SlamMap& map, const std::vector<LoopEdge>& loops,
                                  map::KeyframeId firstFree, const LoopOptions& options);

/// Pure. An update without poses if the graph cannot be solved.
PoseGraphUpdate solve(const PoseGraphProblem& problem);

}  // namespace djpete::backend
