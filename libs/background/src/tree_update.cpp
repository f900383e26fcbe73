#include "tree_update.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace djpete::background {

namespace {

using Node = octomap::ColorOcTreeNode;
using Tree = octomap::ColorOcTree;

/// One pass over the bricks of a scan.
class BrickUpdater {
  public:
    BrickUpdater(Tree& tree, double hitProbability, const OctoOptions& options)
        : tree_(tree),
          options_(options),
          hit_(octomap::logodds(hitProbability)),
          miss_(tree.getProbMissLog()),
          low_(tree.getClampingThresMinLog()),
          high_(tree.getClampingThresMaxLog()) {}

    void update(const Cell& origin, uint64_t hits, uint64_t frees) {
        // Refused unless some bit makes nodes; frees alone do only if free space is kept.
        const bool makes = hits != 0 || options_.store_free_space;
        bool fresh = false;
        Node* brick = find(origin, makes, fresh);
        if (!brick) {
            if (makes) count_.refused += bits(hits | frees);
            return;
        }
        for (unsigned octant = 0; octant < 8; ++octant) {
            const auto h = static_cast<unsigned>((hits >> (8U * octant)) & 0xFFU);
            const auto f = static_cast<unsigned>((frees >> (8U * octant)) & 0xFFU);
            if ((h | f) != 0) updateOctant(brick, octant, h, f, fresh);
        }
    }
    const UpdateCount& count() const { return count_; }

  private:
    static uint64_t bits(uint64_t word) {
        uint64_t n = 0;
        for (; word != 0; word &= word - 1) ++n;
        return n;
    }
    bool room() const { return tree_.size() + 8 < options_.max_nodes; }

    /// The child, made if it may be; `fresh` says that `node` was just made and is no pruned leaf,
    /// and afterwards the same of the child.
    Node* child(Node* node, unsigned index, bool mayMake, bool& fresh) {
        if (tree_.nodeChildExists(node, index)) {
            fresh = false;
            return tree_.getNodeChild(node, index);
        }
        const bool prunedLeaf = !fresh && !tree_.nodeHasChildren(node);
        if (prunedLeaf) {
            if (!room()) return nullptr;
            tree_.expandNode(node);
            fresh = false;
            return tree_.getNodeChild(node, index);
        }
        if (!mayMake || !room()) return nullptr;
        fresh = true;
        return tree_.createNodeChild(node, index);
    }

    /// The node two levels above the cells of the brick.
    Node* find(const Cell& origin, bool mayMake, bool& fresh) {
        Node* node = tree_.getRoot();
        fresh = false;
        for (unsigned bit = 15; bit >= 2 && node; --bit) {
            const unsigned index = ((static_cast<unsigned>(origin[0]) >> bit) & 1U) |
                                   (((static_cast<unsigned>(origin[1]) >> bit) & 1U) << 1U) |
                                   (((static_cast<unsigned>(origin[2]) >> bit) & 1U) << 2U);
            node = child(node, index, mayMake, fresh);
        }
        return node;
    }

    void updateOctant(Node* brick, unsigned octant, unsigned hits, unsigned frees, bool fresh) {
        const bool makes = hits != 0 || options_.store_free_space;
        Node* node = child(brick, octant, makes, fresh);
        if (!node) {
            if (makes) count_.refused += bits(hits | frees);
            return;
        }
        for (unsigned i = 0; i < 8; ++i) {
            const bool hit = (hits >> i) & 1U;
            if (!hit && !((frees >> i) & 1U)) continue;
            bool freshLeaf = fresh;
            Node* leaf = child(node, i, hit || options_.store_free_space, freshLeaf);
            if (leaf) {
                apply(*leaf, hit);
                fresh = false;
            } else if (hit || options_.store_free_space) {
                ++count_.refused;
            }
        }
    }

    void apply(Node& leaf, bool hit) {
        ++(hit ? count_.hits : count_.frees);
        const float value = leaf.getLogOdds() + (hit ? hit_ : miss_);
        leaf.setLogOdds(std::clamp(value, low_, high_));
    }

    Tree& tree_;
    const OctoOptions& options_;
    float hit_, miss_, low_, high_;
    UpdateCount count_;
};

void mixColour(Node& node, const std::array<uint8_t, 3>& rgb) {
    if (!node.isColorSet()) {
        node.setColor(rgb[0], rgb[1], rgb[2]);
    } else {
        // The latest views count most: they are the nearest of a forward drive.
        const auto old = node.getColor();
        const auto mixed = [](uint8_t a, uint8_t b) {
            return static_cast<uint8_t>((3U * a + b + 2U) / 4U);
        };
        node.setColor(mixed(old.r, rgb[0]), mixed(old.g, rgb[1]), mixed(old.b, rgb[2]));
    }
    // White means uncoloured to octomap.
    if (!node.isColorSet()) node.setColor(254, 254, 254);
}

std::optional<Node::Color> neighboursColour(const Tree& tree, const octomap::OcTreeKey& key) {
    unsigned red = 0, green = 0, blue = 0, count = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
            octomap::OcTreeKey other = key;
            other[axis] = static_cast<octomap::key_type>(other[axis] + step);
            const Node* node = tree.search(other);
            if (!node || !tree.isNodeOccupied(node) || !node->isColorSet()) continue;
            const auto c = node->getColor();
            red += c.r;
            green += c.g;
            blue += c.b;
            ++count;
        }
    }
    if (count == 0) return std::nullopt;
    const auto mean = [&](unsigned sum) {
        return static_cast<uint8_t>(std::min(254U, (sum + count / 2) / count));
    };
    return Node::Color(mean(red), mean(green), mean(blue));
}

/// octomap makes the root only in its own updates.
void ensureRoot(Tree& tree, const Cell& cell) {
    if (tree.getRoot()) return;
    tree.updateNode(keyOf(cell), 0.0F, true);
}

}  // namespace

uint64_t spreadColours(Tree& tree, unsigned rounds) {
    std::vector<octomap::OcTreeKey> bare;
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
        if (leaf.getDepth() == tree.getTreeDepth() && tree.isNodeOccupied(*leaf) &&
            !leaf->isColorSet()) {
            bare.push_back(leaf.getKey());
        }
    }
    uint64_t coloured = 0;
    for (unsigned round = 0; round < rounds; ++round) {
        std::vector<std::pair<octomap::OcTreeKey, Node::Color>> found;
        std::vector<octomap::OcTreeKey> rest;
        for (const auto& key : bare) {
            if (const auto colour = neighboursColour(tree, key)) {
                found.emplace_back(key, *colour);
            } else {
                rest.push_back(key);
            }
        }
        for (const auto& [key, colour] : found) tree.search(key)->setColor(colour);
        coloured += found.size();
        bare = std::move(rest);
    }
    return coloured;
}

octomap::OcTreeKey keyOf(const Cell& c) {
    return {static_cast<octomap::key_type>(c[0]), static_cast<octomap::key_type>(c[1]),
            static_cast<octomap::key_type>(c[2])};
}

UpdateCount updateTree(octomap::ColorOcTree& tree, const RayMarks& marks, double hitProbability,
                       const OctoOptions& options) {
    const auto& bricks = marks.hits.bricks();
    BrickUpdater updater(tree, hitProbability, options);
    for (int x = 0; x < bricks[0]; ++x) {
        for (int y = 0; y < bricks[1]; ++y) {
            for (int z = 0; z < bricks[2]; ++z) {
                const std::size_t word = marks.hits.wordAt(x, y, z);
                const uint64_t hits = marks.hits.words()[word], free = marks.free.words()[word];
                if ((hits | free) == 0) continue;
                const Cell origin = marks.hits.origin(x, y, z);
                ensureRoot(tree, origin);
                updater.update(origin, hits, free);
            }
        }
    }
    for (const auto& c : marks.colours) {
        if (Node* node = tree.search(keyOf(c.cell))) mixColour(*node, c.rgb);
    }
    return updater.count();
}

}  // namespace djpete::background
