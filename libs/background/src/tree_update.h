/// Whole bricks of cells into an octree at once. Private: brings octomap.
#pragma once

#include <octomap/ColorOcTree.h>

#include "ray_marks.h"

namespace djpete::background {

struct UpdateCount {
    uint64_t hits = 0, frees = 0;
    uint64_t refused = 0;  ///< cells that the tree had no room for
};

/// Updates the log-odds of all marked cells and the colours of hit ones; inner nodes are left for
/// updateInnerOccupancy(). A brick is found once and its cells are updated below it, which is many
/// times faster than a walk from the root for each. No node is made beyond `max_nodes`.
UpdateCount updateTree(octomap::ColorOcTree& tree, const RayMarks& marks, double hitProbability,
                       const OctoOptions& options);

/// Gives every occupied leaf without a colour the mean of the six neighbours that have one,
/// `rounds` times. The tree must not have been pruned. Returns how many leaves it coloured.
uint64_t spreadColours(octomap::ColorOcTree& tree, unsigned rounds);

octomap::OcTreeKey keyOf(const Cell& c);

}  // namespace djpete::background
