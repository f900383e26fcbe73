/// Well mixed numbers, the same on every machine.
#pragma once

#include <cstdint>

namespace djpete::obs {

/// SplitMix64's mixing of one number (Steele, Lea and Flood 2014).
uint64_t mixed(uint64_t number);

/// The next of SplitMix64's sequence; `state` moves on.
uint64_t nextRandom(uint64_t& state);

}  // namespace djpete::obs
