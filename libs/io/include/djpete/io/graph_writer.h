/// The map as a pose graph that MRPT's graph tools read.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>

#include <optional>
#include <string>
#include <vector>

#include "djpete/map/slam_map.h"

namespace djpete::io {

/// What a node of the graph stands for.
struct GraphNode {
    mrpt::graphs::TNodeID node = 0;
    std::optional<map::KeyframeId> keyframe;  ///< the vehicle at a keyframe, or when a moving
                                              ///< object was there
    std::optional<map::ObjectId> object;      ///< set: an object node
    map::FrameId frame;  ///< of the keyframe; for a static object its last state
};

struct PoseGraph {
    mrpt::graphs::CNetworkOfPoses3DInf graph;
    std::vector<GraphNode> nodes;
};

/// Nodes: T_world_vehicle at every keyframe (ids 0, 1, ... in order), then one per static object
/// and one per moving object and keyframe that observed it, T_world_obj. The vehicle stands for
/// its camera because seen from an optical frame the heading of a car ahead is a pitch of 90
/// degrees, where the yaw-pitch-roll of MRPT's text format is singular.
/// Edges: consecutive keyframes by odometry; other keyframes that share at least 30 landmarks by
/// their estimates; vehicle to object by each detection, its information turned exactly into
/// MRPT's (x, y, z, yaw, pitch, roll) of the edge pose. Detections of frames between keyframes
/// hang on their reference keyframe if the object is static, and are left out if it moves.
PoseGraph makePoseGraph(const map::SlamMap& map);

/// MRPT's text with 15 digits, plus `file`.nodes.csv (node,kind,keyframe_id,object_id,frame),
/// since the text format keeps no annotations.
void writePoseGraph(const map::SlamMap& map, const std::string& file);

}  // namespace djpete::io
