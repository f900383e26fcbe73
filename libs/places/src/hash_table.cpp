#include "hash_table.h"

#include <utility>

namespace djpete::places {

namespace {

/// SplitMix64's mixing of one number.
uint64_t mixed(uint64_t z) {
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

}  // namespace

BitChoice::BitChoice(unsigned table, unsigned keyBits) : keyBits_(keyBits) {
    std::array<uint8_t, 256> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<uint8_t>(i);
    for (std::size_t i = 0; i < bits_.size(); ++i) {
        const std::size_t j = i + mixed(table * 1000ULL + i) % (all.size() - i);
        std::swap(all[i], all[j]);
        bits_[i] = all[i];
    }
}

HashTable::HashTable(unsigned table, unsigned keyBits)
    : bits_(table, keyBits), heads_(std::size_t{1} << keyBits, kEnd) {}

void HashTable::add(const obs::Descriptor& d, CornerName name) {
    uint32_t& head = heads_[bits_.key(d)];
    if (head == kEnd || blocks_[head].count == blocks_[head].entries.size()) {
        Block block;
        block.next = head;
        head = static_cast<uint32_t>(blocks_.size());
        blocks_.push_back(block);
    }
    Block& block = blocks_[head];
    block.entries[block.count++] = {name, bits_.signature(d)};
}

}  // namespace djpete::places
