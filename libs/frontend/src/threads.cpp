#include "djpete/frontend/threads.h"

#include <opencv2/core/utility.hpp>

namespace djpete::frontend {

void useThreads(unsigned threads) {
    // OpenCV: 0 switches threading off, negative is its own default.
    cv::setNumThreads(threads == 0 ? -1 : static_cast<int>(threads));
}

}  // namespace djpete::frontend
