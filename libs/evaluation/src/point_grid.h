/// Nearest neighbours among points. Private to the room.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace djpete::evaluation {

/// Points sorted into cubes of side `reach`: a neighbour within reach is in one of 27 cubes.
class PointGrid {
  public:
    /// `reach` > 0. Points are finite and less than a million cubes from the origin.
    PointGrid(const std::vector<std::array<float, 3>>& points, double reach);

    /// Index of the nearest point within reach that `accept`(index) takes; the first of equal ones.
    template <class Accept>
    std::optional<uint32_t> nearest(const std::array<float, 3>& p, const Accept& accept) const {
        std::optional<uint32_t> best;
        float best2 = reach_ * reach_;
        visitCubes(p, [&](const Entry& e) {
            const float d2 = distance2(e.p, p);
            if (d2 > best2 || (d2 == best2 && best && e.index >= *best)) return;
            if (!accept(e.index)) return;
            best = e.index;
            best2 = d2;
        });
        return best;
    }
    bool any(const std::array<float, 3>& p) const {
        return nearest(p, [](uint32_t) { return true; }).has_value();
    }

  private:
    struct Entry {
        uint64_t key;
        uint32_t index;
        std::array<float, 3> p;
    };
    static float distance2(const std::array<float, 3>& a, const std::array<float, 3>& b) {
        const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
        return x * x + y * y + z * z;
    }
    int64_t cell(float x) const;
    static uint64_t keyOf(int64_t x, int64_t y, int64_t z);
    const Entry* lower(uint64_t key) const;
    template <class Visit>
    void visitCubes(const std::array<float, 3>& p, const Visit& visit) const {
        const int64_t cx = cell(p[0]), cy = cell(p[1]), cz = cell(p[2]);
        for (int64_t x = cx - 1; x <= cx + 1; ++x) {
            for (int64_t y = cy - 1; y <= cy + 1; ++y) {
                // z is the fastest part of a key: three cubes lie together.
                const uint64_t last = keyOf(x, y, cz + 1);
                const Entry* const end = entries_.data() + entries_.size();
                for (const Entry* e = lower(keyOf(x, y, cz - 1)); e != end && e->key <= last; ++e) {
                    visit(*e);
                }
            }
        }
    }

    float reach_;
    std::vector<Entry> entries_;  ///< sorted by key, then index
};

}  // namespace djpete::evaluation
