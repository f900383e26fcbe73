/// One table of a locality-sensitive hash: lists of corners by some bits of their descriptors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/obs/CObservationVisualKeyframe.h"

namespace djpete::places {

/// A corner of a view in the database.
struct CornerName {
    static constexpr unsigned kCornerBits = 11;
    static constexpr std::size_t kMaxCorners = std::size_t{1} << kCornerBits;
    static constexpr std::size_t kMaxViews = std::size_t{1} << (32 - kCornerBits);
    uint32_t packed = 0;
    static CornerName of(std::size_t view, std::size_t corner) {
        return {static_cast<uint32_t>(view << kCornerBits | corner)};
    }
    std::size_t view() const { return packed >> kCornerBits; }
    std::size_t corner() const { return packed & (kMaxCorners - 1); }
};

/// Which bits make the key, and 32 others that tell most unlike corners without their descriptor.
class BitChoice {
  public:
    /// The bits of table `table`: a fixed permutation of all 256 by an integer hash.
    BitChoice(unsigned table, unsigned keyBits);
    uint32_t key(const obs::Descriptor& d) const { return gather(d, 0, keyBits_); }
    uint32_t signature(const obs::Descriptor& d) const { return gather(d, keyBits_, 32); }

  private:
    uint32_t gather(const obs::Descriptor& d, unsigned first, unsigned count) const {
        uint32_t out = 0;
        for (unsigned i = 0; i < count; ++i) {
            const unsigned bit = bits_[first + i];
            out |= static_cast<uint32_t>(d[bit >> 6] >> (bit & 63) & 1) << i;
        }
        return out;
    }
    std::array<uint8_t, 64> bits_{};
    unsigned keyBits_;
};

/// Lists in blocks of one array, so that many short lists waste little.
class HashTable {
  public:
    struct Entry {
        CornerName name;
        uint32_t signature = 0;
    };
    HashTable(unsigned table, unsigned keyBits);

    const BitChoice& bits() const { return bits_; }
    void add(const obs::Descriptor& d, CornerName name);
    /// Calls action(entry) for up to `most` entries of a list, the newest first.
    template <class Action>
    void forEach(uint32_t key, std::size_t most, const Action& action) const {
        std::size_t left = most;
        for (uint32_t at = heads_[key]; at != kEnd && left > 0; at = blocks_[at].next) {
            const Block& block = blocks_[at];
            for (uint32_t i = block.count; i > 0 && left > 0; --i, --left) {
                action(block.entries[i - 1]);
            }
        }
    }
    std::size_t bytes() const {
        return heads_.size() * sizeof(uint32_t) + blocks_.capacity() * sizeof(Block);
    }

  private:
    static constexpr uint32_t kEnd = 0xFFFFFFFFU;
    /// One cache line.
    struct Block {
        uint32_t next = kEnd;
        uint32_t count = 0;
        std::array<Entry, 7> entries;
    };
    BitChoice bits_;
    std::vector<uint32_t> heads_;  // by key
    std::vector<Block> blocks_;
};

}  // namespace djpete::places
