#include "hamming.h"

namespace djpete::places {

namespace {

/// Bits set in a word, by sums of neighbouring pairs, nibbles and bytes.
inline unsigned bitsPortable(uint64_t x) {
    x -= (x >> 1) & 0x5555555555555555ULL;
    x = (x & 0x3333333333333333ULL) + ((x >> 2) & 0x3333333333333333ULL);
    x = (x + (x >> 4)) & 0x0F0F0F0F0F0F0F0FULL;
    return static_cast<unsigned>((x * 0x0101010101010101ULL) >> 56);
}

inline void offer(Nearest& n, unsigned distance, unsigned index) {
    if (distance < n.best) {
        n.second = n.best;
        n.best = distance;
        n.index = index;
    } else if (distance < n.second) {
        n.second = distance;
    }
}

#if defined(__x86_64__)
__attribute__((target("popcnt"))) unsigned hammingPopcnt(const obs::Descriptor& a,
                                                         const obs::Descriptor& b) {
    return static_cast<unsigned>(
        __builtin_popcountll(a[0] ^ b[0]) + __builtin_popcountll(a[1] ^ b[1]) +
        __builtin_popcountll(a[2] ^ b[2]) + __builtin_popcountll(a[3] ^ b[3]));
}

__attribute__((target("popcnt"))) std::vector<Nearest> nearestPopcnt(
    const std::vector<obs::Descriptor>& from, const std::vector<obs::Descriptor>& to) {
    std::vector<Nearest> out(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        const obs::Descriptor a = from[i];
        Nearest n;
        for (std::size_t j = 0; j < to.size(); ++j) {
            const obs::Descriptor& b = to[j];
            const auto d = static_cast<unsigned>(
                __builtin_popcountll(a[0] ^ b[0]) + __builtin_popcountll(a[1] ^ b[1]) +
                __builtin_popcountll(a[2] ^ b[2]) + __builtin_popcountll(a[3] ^ b[3]));
            offer(n, d, static_cast<unsigned>(j));
        }
        out[i] = n;
    }
    return out;
}

bool hasPopcnt() {
    static const bool has = __builtin_cpu_supports("popcnt") != 0;
    return has;
}
#endif

}  // namespace

unsigned hammingPortable(const obs::Descriptor& a, const obs::Descriptor& b) {
    return bitsPortable(a[0] ^ b[0]) + bitsPortable(a[1] ^ b[1]) + bitsPortable(a[2] ^ b[2]) +
           bitsPortable(a[3] ^ b[3]);
}

std::vector<Nearest> nearestPortable(const std::vector<obs::Descriptor>& from,
                                     const std::vector<obs::Descriptor>& to) {
    std::vector<Nearest> out(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        for (std::size_t j = 0; j < to.size(); ++j) {
            offer(out[i], hammingPortable(from[i], to[j]), static_cast<unsigned>(j));
        }
    }
    return out;
}

std::vector<Nearest> nearest(const std::vector<obs::Descriptor>& from,
                             const std::vector<obs::Descriptor>& to) {
#if defined(__x86_64__)
    if (hasPopcnt()) return nearestPopcnt(from, to);
#endif
    return nearestPortable(from, to);
}

HammingFunction hammingFunction() {
#if defined(__x86_64__)
    if (hasPopcnt()) return hammingPopcnt;
#endif
    return hammingPortable;
}

}  // namespace djpete::places
