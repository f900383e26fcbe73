/// A box of cells as bits, 4 x 4 x 4 cells to a 64-bit word: such a brick is a node of an octree.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace djpete::background {

/// Index of a cell of the world, 0..65535 per axis as in an octree of depth 16.
using Cell = std::array<int, 3>;

/// Bits of the cells from `low` to `high` (both inclusive, grown to whole bricks).
class BrickGrid {
  public:
    BrickGrid(const Cell& low, const Cell& high) {
        std::size_t words = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            first_[i] = low[i] >> 2;
            count_[i] = (high[i] >> 2) - first_[i] + 1;
            words *= static_cast<std::size_t>(count_[i]);
        }
        words_.assign(words, 0);
    }

    /// Per axis and cell from the first one on: what the cell adds to the number of its bit, so
    /// that bit b is (words[b / 64] >> (b % 64)) & 1.
    std::array<std::vector<uint32_t>, 3> bitTables() const {
        std::array<std::vector<uint32_t>, 3> out;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (int i = 0; i < 4 * count_[axis]; ++i) {
                std::array<int, 3> brick{0, 0, 0};
                Cell within{0, 0, 0};
                brick[axis] = i >> 2;
                within[axis] = i & 3;
                out[axis].push_back(
                    static_cast<uint32_t>(64 * wordAt(brick[0], brick[1], brick[2])) +
                    bitIndex(within));
            }
        }
        return out;
    }
    Cell firstCell() const { return origin(0, 0, 0); }
    void set(const Cell& c) { words_[wordOf(c)] |= bitOf(c); }
    void clear(const Cell& c) { words_[wordOf(c)] &= ~bitOf(c); }
    bool test(const Cell& c) const { return (words_[wordOf(c)] & bitOf(c)) != 0; }
    bool holds(const Cell& c) const {
        for (std::size_t i = 0; i < 3; ++i) {
            const int brick = (c[i] >> 2) - first_[i];
            if (c[i] < 0 || brick < 0 || brick >= count_[i]) return false;
        }
        return true;
    }

    std::vector<uint64_t>& words() { return words_; }
    const std::vector<uint64_t>& words() const { return words_; }
    const std::array<int, 3>& bricks() const { return count_; }
    /// The first cell of brick (bx, by, bz); words are ordered z fastest.
    Cell origin(int bx, int by, int bz) const {
        return {(first_[0] + bx) << 2, (first_[1] + by) << 2, (first_[2] + bz) << 2};
    }
    std::size_t wordAt(int bx, int by, int bz) const {
        return (static_cast<std::size_t>(bx) * static_cast<std::size_t>(count_[1]) +
                static_cast<std::size_t>(by)) *
                   static_cast<std::size_t>(count_[2]) +
               static_cast<std::size_t>(bz);
    }
    /// Bits of a brick are in the order of an octree's children: the upper three bits choose the
    /// child (x in bit 0, y in bit 1, z in bit 2), the lower three its child.
    static unsigned bitIndex(const Cell& c) {
        const auto x = static_cast<unsigned>(c[0]), y = static_cast<unsigned>(c[1]),
                   z = static_cast<unsigned>(c[2]);
        return (((x >> 1U) & 1U) << 3U) | (((y >> 1U) & 1U) << 4U) | (((z >> 1U) & 1U) << 5U) |
               (x & 1U) | ((y & 1U) << 1U) | ((z & 1U) << 2U);
    }

  private:
    static uint64_t bitOf(const Cell& c) { return uint64_t{1} << bitIndex(c); }
    std::size_t wordOf(const Cell& c) const {
        return wordAt((c[0] >> 2) - first_[0], (c[1] >> 2) - first_[1], (c[2] >> 2) - first_[2]);
    }

    std::array<int, 3> first_{}, count_{};
    std::vector<uint64_t> words_;
};

}  // namespace djpete::background
