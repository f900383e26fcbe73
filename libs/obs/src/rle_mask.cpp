#include "djpete/obs/rle_mask.h"

#include <algorithm>

namespace djpete::obs {

RleMask RleMask::fromDense(const uint8_t* pixels, uint32_t width_px, uint32_t height_px,
                           std::size_t strideBytes) {
    RleMask out{width_px, height_px, {}};
    bool foreground = false;
    uint32_t run = 0;
    for (uint32_t v = 0; v < height_px; ++v) {
        const uint8_t* row = pixels + v * strideBytes;
        for (uint32_t u = 0; u < width_px; ++u) {
            if ((row[u] != 0) != foreground) {
                out.runs.push_back(run);
                run = 0;
                foreground = !foreground;
            }
            ++run;
        }
    }
    out.runs.push_back(run);
    return out;
}

std::vector<uint8_t> RleMask::toDense() const {
    std::vector<uint8_t> out(static_cast<std::size_t>(width_px) * height_px, 0);
    std::size_t at = 0;
    for (std::size_t i = 0; i < runs.size() && at < out.size(); ++i) {
        const std::size_t end = std::min(out.size(), at + runs[i]);
        if (i % 2 == 1)
            std::fill(out.begin() + static_cast<long>(at), out.begin() + static_cast<long>(end),
                      255);
        at = end;
    }
    return out;
}

uint64_t RleMask::area_px() const {
    uint64_t sum = 0;
    for (std::size_t i = 1; i < runs.size(); i += 2) sum += runs[i];
    return sum;
}

bool RleMask::consistent() const {
    uint64_t sum = 0;
    for (uint32_t r : runs) sum += r;
    return sum == static_cast<uint64_t>(width_px) * height_px;
}

}  // namespace djpete::obs
