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
    /// Entries of a list.
    uint32_t length(uint32_t key) const { return lists_[key].length; }
    /// Calls action(entry) for all entries of a list, the newest first.
    template <class Action>
    void forEach(uint32_t key, const Action& action) const {
        uint32_t inBlock = firstBlockCount(lists_[key].length);
        for (uint32_t at = lists_[key].head; at != kEnd; at = blockAt(at).next) {
            const Block& block = blockAt(at);
            for (uint32_t i = inBlock; i > 0; --i) action(block.entries[i - 1]);
            inBlock = kPerBlock;
        }
    }
    std::size_t bytes() const {
        return lists_.size() * sizeof(List) + chunks_.size() * kPerChunk * sizeof(Block);
    }

  private:
    static constexpr uint32_t kEnd = 0xFFFFFFFFU;
    static constexpr uint32_t kPerBlock = 3, kPerChunk = 1024;
    /// Only the newest block of a list may be part full.
    struct Block {
        uint32_t next = kEnd;
        std::array<Entry, kPerBlock> entries;
    };
    struct List {
        uint32_t head = kEnd, length = 0;
    };
    static uint32_t firstBlockCount(uint32_t length) {
        return (length + kPerBlock - 1) % kPerBlock + 1;
    }
    const Block& blockAt(uint32_t at) const { return chunks_[at / kPerChunk][at % kPerChunk]; }
    Block& blockAt(uint32_t at) { return chunks_[at / kPerChunk][at % kPerChunk]; }

    BitChoice bits_;
    std::vector<List> lists_;                 // by key
    std::vector<std::vector<Block>> chunks_;  // of kPerChunk blocks each
    uint32_t blocks_ = 0;
};

}  // namespace djpete::places
