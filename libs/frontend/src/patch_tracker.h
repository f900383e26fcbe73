/// Following patches from one image to the next.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "djpete/frontend/options.h"

namespace djpete::frontend {

/// An 8 bit grey image and its halves; level 0 is a copy, so that the caller may reuse the image.
class GreyPyramid {
  public:
    /// Takes over the image; memory of an earlier image of the same size is used again.
    void build(const cv::Mat& grey, int levelsAboveFull);
    const cv::Mat& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }
    const cv::Mat& grey() const { return level(0); }
    int levelsAboveFull() const { return static_cast<int>(levels_.size()) - 1; }
    bool empty() const { return levels_.empty(); }

  private:
    std::vector<cv::Mat> levels_;
};

/// From which pyramid level down to which a patch is sought.
struct LevelRange {
    int coarsest = 0, finest = 0;
};

/// Where the patch about `from_px` went, starting at `guess_px`. Levels where it lies too near the
/// border or has no texture are left out, but not the finest. Nothing if the patch leaves the image
/// or correlates less than options.kltMinCorrelation.
std::optional<cv::Point2f> followPatch(const GreyPyramid& from, const GreyPyramid& to,
                                       const cv::Point2f& from_px, const cv::Point2f& guess_px,
                                       const LevelRange& levels, const FrontendOptions& options);

/// The same from level `coarsest` to full size; the patch must return within
/// options.kltForwardBackward_px when followed back.
std::optional<cv::Point2f> followPatchForthAndBack(const GreyPyramid& from, const GreyPyramid& to,
                                                   const cv::Point2f& from_px,
                                                   const cv::Point2f& guess_px, int coarsest,
                                                   const FrontendOptions& options);

}  // namespace djpete::frontend
