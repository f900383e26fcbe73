/// Frames A..B-1, as `--range A:B` says it.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace djpete::apps {

struct FrameRange {
    uint64_t begin = 0;
    uint64_t end = std::numeric_limits<uint64_t>::max();
    bool contains(uint64_t frame) const { return frame >= begin && frame < end; }
};

/// "A:B" with whole numbers A < B; either may be left out; "" is all frames. Throws
/// obs::InputError.
FrameRange parseFrameRange(const std::string& text);

}  // namespace djpete::apps
