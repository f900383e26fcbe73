#pragma once

#include <algorithm>
#include <cstring>
#include <opencv2/core.hpp>

namespace djpete::frontend {

/// Sets the square of 2 * reach + 1 pixels about (x, y), cut at the border, to 255.
inline void markTaken(cv::Mat& mask, int x, int y, int reach) {
    const int left = std::max(0, x - reach), right = std::min(mask.cols, x + reach + 1);
    if (left >= right) return;
    for (int row = std::max(0, y - reach); row < std::min(mask.rows, y + reach + 1); ++row)
        std::memset(mask.ptr<uint8_t>(row) + left, 255, static_cast<std::size_t>(right - left));
}

}  // namespace djpete::frontend
