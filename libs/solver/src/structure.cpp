#include "structure.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace djpete::solver {

namespace {

using detail::Kind;

/// Numbers the blocks of an upper triangle in order of first use.
class BlockNumbers {
  public:
    BlockNumbers(int n, std::vector<std::pair<int, int>>& blocks) : n_(n), blocks_(blocks) {
        if (n_ <= kTableUpTo) table_.assign(std::size_t(n_) * std::size_t(n_), -1);
        for (int i = 0; i < n_; ++i) of(i, i);
    }
    /// Number of block (i, j), i <= j.
    int of(int i, int j) {
        const auto key = std::size_t(i) * std::size_t(n_) + std::size_t(j);
        int& number = table_.empty() ? map_.try_emplace(key, -1).first->second : table_[key];
        if (number < 0) {
            number = int(blocks_.size());
            blocks_.emplace_back(i, j);
        }
        return number;
    }

  private:
    static constexpr int kTableUpTo = 1024;
    int n_;
    std::vector<std::pair<int, int>>& blocks_;
    std::vector<int> table_;
    std::unordered_map<std::size_t, int> map_;  // looked up only, never walked through
};

/// Free index of every variable of the problem, or -1.
struct FreeIndex {
    std::vector<int> pose, point, vector;
    int& of(Kind kind, int i) {
        auto& v = kind == Kind::Pose ? pose : kind == Kind::Point ? point : vector;
        return v[std::size_t(i)];
    }
};

constexpr int kSeen = -2;

FreeIndex seenVariables(const Problem& problem) {
    FreeIndex free;
    free.pose.assign(std::size_t(problem.numPoses()), -1);
    free.point.assign(std::size_t(problem.numPoints()), -1);
    free.vector.assign(std::size_t(problem.numVectors()), -1);
    for (int g = 0; g < problem.numGroups(); ++g) {
        const auto& group = problem.group(g);
        const auto& kinds = group.kinds();
        for (int e = 0; e < group.size(); ++e) {
            if (!group.enabled(e)) continue;
            for (std::size_t k = 0; k < kinds.size(); ++k) {
                const int i = group.variables(e)[k];
                if (!problem.isConstant(kinds[k], i)) free.of(kinds[k], i) = kSeen;
            }
        }
    }
    return free;
}

void number(FreeIndex& free, Structure& s) {
    const auto numberSixes = [&s](std::vector<int>& index, Kind kind) {
        for (std::size_t i = 0; i < index.size(); ++i) {
            if (index[i] != kSeen) continue;
            index[i] = s.numSixes();
            s.sixes.emplace_back(kind, int(i));
        }
    };
    numberSixes(free.pose, Kind::Pose);
    numberSixes(free.vector, Kind::Vector);
    for (std::size_t i = 0; i < free.point.size(); ++i) {
        if (free.point[i] != kSeen) continue;
        free.point[i] = s.numPoints();
        s.points.push_back(int(i));
    }
}

/// The free sixes of an entry (-1 where constant), and its free point or -1.
struct EntryVariables {
    std::vector<int> sixes;
    int point = -1;
    bool anySix() const {
        return std::any_of(sixes.begin(), sixes.end(), [](int s) { return s >= 0; });
    }
};

void entryVariables(const detail::ResidualGroup& group, int entry, FreeIndex& free,
                    EntryVariables& out) {
    out.sixes.clear();
    out.point = -1;
    const auto& kinds = group.kinds();
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const int index = free.of(kinds[k], group.variables(entry)[k]);
        if (kinds[k] == Kind::Point) {
            out.point = index;
        } else {
            out.sixes.push_back(index);
        }
    }
}

/// Sorts a group's entries into those with a free point (by point) and the others.
void sortEntries(const detail::ResidualGroup& group, FreeIndex& free, int numPoints,
                 GroupLinks& links) {
    EntryVariables v;
    std::vector<int> pointOf(std::size_t(group.size()), -1);
    links.pointStart.assign(std::size_t(numPoints) + 1, 0);
    for (int e = 0; e < group.size(); ++e) {
        if (!group.enabled(e)) continue;
        entryVariables(group, e, free, v);
        pointOf[std::size_t(e)] = v.point;
        if (v.point >= 0) {
            ++links.pointStart[std::size_t(v.point) + 1];
        } else if (v.anySix()) {
            links.entries.push_back(e);
        }
    }
    for (std::size_t p = 0; p < std::size_t(numPoints); ++p) {
        links.pointStart[p + 1] += links.pointStart[p];
    }
    links.pointEntries.resize(std::size_t(links.pointStart.back()));
    std::vector<int> next(links.pointStart.begin(), links.pointStart.end() - 1);
    for (int e = 0; e < group.size(); ++e) {
        const int p = pointOf[std::size_t(e)];
        if (p >= 0) links.pointEntries[std::size_t(next[std::size_t(p)]++)] = e;
    }
}

/// Collects, per point, the distinct sixes that see it.
void findSlots(const Problem& problem, FreeIndex& free, Structure& s) {
    EntryVariables v;
    std::vector<int> seen;
    s.slotStart.assign(1, 0);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
        seen.clear();
        for (int g = 0; g < problem.numGroups(); ++g) {
            const GroupLinks& links = s.groups[std::size_t(g)];
            for (int k = links.pointStart[p]; k < links.pointStart[p + 1]; ++k) {
                entryVariables(problem.group(g), links.pointEntries[std::size_t(k)], free, v);
                for (int six : v.sixes) {
                    if (six >= 0) seen.push_back(six);
                }
            }
        }
        std::sort(seen.begin(), seen.end());
        seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
        s.slotSix.insert(s.slotSix.end(), seen.begin(), seen.end());
        s.slotStart.push_back(int(s.slotSix.size()));
        s.maxSlots = std::max(s.maxSlots, int(seen.size()));
    }
}

void findPairs(Structure& s, BlockNumbers& blocks) {
    s.pairStart.assign(1, 0);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
        for (int i = s.slotStart[p]; i < s.slotStart[p + 1]; ++i) {
            for (int j = i; j < s.slotStart[p + 1]; ++j) {
                s.pairBlock.push_back(
                    blocks.of(s.slotSix[std::size_t(i)], s.slotSix[std::size_t(j)]));
            }
        }
        s.pairStart.push_back(s.pairBlock.size());
    }
}

/// Appends the links of one entry, laid out as detail::linkStride says.
void appendLinks(const EntryVariables& v, const int* slots, int numSlots, BlockNumbers& blocks,
                 std::vector<int>& out) {
    for (int six : v.sixes) {
        out.push_back(six);
        const int* slot =
            six < 0 ? slots + numSlots : std::lower_bound(slots, slots + numSlots, six);
        out.push_back(slot == slots + numSlots ? -1 : int(slot - slots));
    }
    for (std::size_t a = 0; a < v.sixes.size(); ++a) {
        for (std::size_t b = a + 1; b < v.sixes.size(); ++b) {
            const int i = v.sixes[a], j = v.sixes[b];
            const bool both = i >= 0 && j >= 0;
            out.push_back(!both ? -1 : i < j ? 2 * blocks.of(i, j) : 2 * blocks.of(j, i) + 1);
        }
    }
}

void linkEntries(const detail::ResidualGroup& group, FreeIndex& free, const Structure& s,
                 BlockNumbers& blocks, GroupLinks& links) {
    const auto& kinds = group.kinds();
    const auto isSix = [](Kind k) { return k != Kind::Point; };
    links.stride = detail::linkStride(int(std::count_if(kinds.begin(), kinds.end(), isSix)));
    EntryVariables v;
    for (int e : links.entries) {
        entryVariables(group, e, free, v);
        appendLinks(v, nullptr, 0, blocks, links.links);
    }
    links.pointLinks.reserve(links.pointEntries.size() * std::size_t(links.stride));
    for (std::size_t p = 0; p < s.points.size(); ++p) {
        const int* slots = s.slotSix.data() + s.slotStart[p];
        const int numSlots = s.slotStart[p + 1] - s.slotStart[p];
        for (int k = links.pointStart[p]; k < links.pointStart[p + 1]; ++k) {
            entryVariables(group, links.pointEntries[std::size_t(k)], free, v);
            appendLinks(v, slots, numSlots, blocks, links.pointLinks);
        }
    }
}

}  // namespace

Structure::Structure(const Problem& problem) {
    FreeIndex free = seenVariables(problem);
    number(free, *this);
    BlockNumbers numbers(numSixes(), blocks);
    groups.resize(std::size_t(problem.numGroups()));
    for (int g = 0; g < problem.numGroups(); ++g) {
        sortEntries(problem.group(g), free, numPoints(), groups[std::size_t(g)]);
    }
    findSlots(problem, free, *this);
    findPairs(*this, numbers);
    for (int g = 0; g < problem.numGroups(); ++g) {
        linkEntries(problem.group(g), free, *this, numbers, groups[std::size_t(g)]);
    }
}

}  // namespace djpete::solver
