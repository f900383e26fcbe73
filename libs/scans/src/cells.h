/// Cubes of space by number.
#pragma once

#include <cmath>
#include <cstdint>

namespace djpete::scans {

/// Number of the cube that holds a point; a cube is 1/`perMetre` wide. Unique within a million
/// cubes of the origin.
template <class Point>
uint64_t cellOf(const Point& p, double perMetre) {
    constexpr int64_t kHalf = 1 << 20;
    constexpr uint64_t kMask = (1 << 21) - 1;
    const auto number = [&](double x) {
        return static_cast<uint64_t>(static_cast<int64_t>(std::floor(x * perMetre)) + kHalf) &
               kMask;
    };
    return (number(double(p[0])) << 42) | (number(double(p[1])) << 21) | number(double(p[2]));
}

/// Spreads the bits of a number over all bits.
inline uint64_t spread(uint64_t cell) {
    cell *= 0x9E3779B97F4A7C15ULL;
    cell ^= cell >> 29;
    cell *= 0xBF58476D1CE4E5B9ULL;
    return cell ^ (cell >> 32);
}

}  // namespace djpete::scans
