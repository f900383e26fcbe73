/// A binary image mask as run lengths.
#pragma once

#include <cstdint>
#include <vector>

namespace djpete::obs {

/// Runs in row-major order over the whole image, alternating background, foreground, background,
/// ...; the first run is background and may be 0. The runs sum to width * height. (COCO's RLE is
/// the same in column-major order.)
struct RleMask {
    uint32_t width_px = 0, height_px = 0;
    std::vector<uint32_t> runs;

    /// From a dense image with `strideBytes` bytes per row; a pixel is foreground if it is not 0.
    static RleMask fromDense(const uint8_t* pixels, uint32_t width_px, uint32_t height_px,
                             std::size_t strideBytes);
    /// Row-major, width * height bytes, foreground 255.
    std::vector<uint8_t> toDense() const;
    /// Number of foreground pixels.
    uint64_t area_px() const;
    /// True if the runs fit the size.
    bool consistent() const;
};

}  // namespace djpete::obs
