/// Distinct, ordered identifiers: a landmark's number never passes for a keyframe's.
#pragma once

#include <cstdint>
#include <functional>

namespace djpete::obs {

template <class Tag>
struct Id {
    uint64_t value = 0;
    friend bool operator==(Id a, Id b) { return a.value == b.value; }
    friend bool operator!=(Id a, Id b) { return a.value != b.value; }
    friend bool operator<(Id a, Id b) { return a.value < b.value; }
    friend bool operator<=(Id a, Id b) { return a.value <= b.value; }
    friend bool operator>(Id a, Id b) { return a.value > b.value; }
    friend bool operator>=(Id a, Id b) { return a.value >= b.value; }
};

/// Number of a frame in its drive (KITTI's own frame number).
using FrameId = Id<struct FrameTag>;
/// A feature followed through images; becomes a landmark in the map.
using TrackId = Id<struct TrackTag>;

}  // namespace djpete::obs
