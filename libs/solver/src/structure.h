/// The sparsity of one solve: which variables move, who meets whom, and where each sum goes.
#pragma once

#include <utility>
#include <vector>

#include "djpete/solver/problem.h"

namespace djpete::solver {

/// Entries of one group, sorted for the two passes.
struct GroupLinks {
    int stride = 0;                 ///< ints per entry in the links
    std::vector<int> entries;       ///< without a free point, with a free six-vector
    std::vector<int> links;         ///< of `entries`
    std::vector<int> pointStart;    ///< per free point, its range in pointEntries (size + 1)
    std::vector<int> pointEntries;  ///< grouped by free point, in order of addition
    std::vector<int> pointLinks;    ///< of `pointEntries`
};

/// Built once per solve. "Six" is a free six-dimensional variable (pose or vector), numbered poses
/// first; "point" is a free point. Only variables that some enabled residual sees are in here.
struct Structure {
    explicit Structure(const Problem& problem);

    int numSixes() const { return int(sixes.size()); }
    int numPoints() const { return int(points.size()); }
    int numBlocks() const { return int(blocks.size()); }
    bool empty() const { return sixes.empty() && points.empty(); }

    std::vector<std::pair<detail::Kind, int>> sixes;  ///< their index in the problem
    std::vector<int> points;                          ///< their index in the problem
    std::vector<GroupLinks> groups;                   ///< as in the problem

    /// Blocks (row <= column) of the reduced system; the first numSixes() are the diagonal.
    std::vector<std::pair<int, int>> blocks;

    // Slots: the distinct sixes that see a point, ascending.
    std::vector<int> slotStart;          ///< per point (size + 1)
    std::vector<int> slotSix;            ///< the six of a slot
    std::vector<std::size_t> pairStart;  ///< per point, into pairBlock (size + 1)
    std::vector<int> pairBlock;  ///< block of each pair of slots i <= j of a point, row by row
    int maxSlots = 0;            ///< of any point
};

}  // namespace djpete::solver
