/// Work on independent items by OpenCV's threads; results do not depend on their number.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

namespace djpete::frontend {

/// Calls work(i) for all i < count. Calls may run side by side: each may write its own item only.
template <class Work>
void forEachItem(std::size_t count, const Work& work) {
    constexpr int kItemsPerTask = 32;
    const int n = static_cast<int>(count);
    cv::parallel_for_(
        cv::Range(0, n),
        [&](const cv::Range& range) {
            for (int i = range.start; i < range.end; ++i) work(static_cast<std::size_t>(i));
        },
        static_cast<double>((n + kItemsPerTask - 1) / kItemsPerTask));
}

}  // namespace djpete::frontend
