#include "hash_table.h"

#include <utility>

#include "djpete/obs/mixing.h"

namespace djpete::places {

BitChoice::BitChoice(unsigned table, unsigned keyBits) : keyBits_(keyBits) {
    std::array<uint8_t, 256> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<uint8_t>(i);
    for (std::size_t i = 0; i < bits_.size(); ++i) {
        const std::size_t j = i + obs::mixed(table * 1000ULL + i) % (all.size() - i);
        std::swap(all[i], all[j]);
        bits_[i] = all[i];
    }
}

HashTable::HashTable(unsigned table, unsigned keyBits)
    : bits_(table, keyBits), lists_(std::size_t{1} << keyBits) {}

void HashTable::add(const obs::Descriptor& d, CornerName name) {
    List& list = lists_[bits_.key(d)];
    const uint32_t at = list.length % kPerBlock;
    if (at == 0) {
        if (blocks_ % kPerChunk == 0) chunks_.emplace_back(kPerChunk);
        blockAt(blocks_).next = list.head;
        list.head = blocks_++;
    }
    blockAt(list.head).entries[at] = {name, bits_.signature(d)};
    ++list.length;
}

}  // namespace djpete::places
