/// How many threads images are worked on with.
#pragma once

namespace djpete::frontend {

/// Process-wide: threads that OpenCV's loops, and those of odometry and texture, may use; 0 means
/// all cores. No influence on any result.
void useThreads(unsigned threads);

}  // namespace djpete::frontend
