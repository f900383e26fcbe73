#include "djpete/obs/mixing.h"

namespace djpete::obs {

namespace {
constexpr uint64_t kStep = 0x9E3779B97F4A7C15ULL;
}

uint64_t mixed(uint64_t number) {
    uint64_t z = number + kStep;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

uint64_t nextRandom(uint64_t& state) {
    const uint64_t out = mixed(state);
    state += kStep;
    return out;
}

}  // namespace djpete::obs
