#include "patch_tracker.h"

#include <opencv2/imgproc.hpp>

#include "patch_alignment.h"

namespace djpete::frontend {

namespace {

constexpr PlacePrior kFree{100.0, 0.0};
/// Of a patch of 11 pixels, at each level.
constexpr SearchReach kReach{7.0, 7.0};

}  // namespace

void GreyPyramid::build(const cv::Mat& grey, int levelsAboveFull) {
    levels_.resize(static_cast<std::size_t>(levelsAboveFull) + 1);
    grey.copyTo(levels_[0]);
    for (std::size_t i = 1; i < levels_.size(); ++i) cv::pyrDown(levels_[i - 1], levels_[i]);
}

std::optional<cv::Point2f> followPatch(const GreyPyramid& from, const GreyPyramid& to,
                                       const cv::Point2f& from_px, const cv::Point2f& guess_px,
                                       const LevelRange& levels, const FrontendOptions& options) {
    double u = guess_px.x, v = guess_px.y;
    for (int i = std::min(levels.coarsest, from.levelsAboveFull()); i >= levels.finest; --i) {
        const double scale = 1 << i;
        const auto patch =
            PatchTemplate::from(from.level(i), from_px.x / scale, from_px.y / scale, kFree);
        PatchPlace start;
        start.u_px = u / scale;
        start.v_px = v / scale;
        const auto place = patch ? patch->align(to.level(i), start, kReach) : std::nullopt;
        if (place && place->correlation >= options.kltMinCorrelation) {
            u = place->u_px * scale;
            v = place->v_px * scale;
        } else if (i == levels.finest) {
            return std::nullopt;
        }
    }
    return cv::Point2f(static_cast<float>(u), static_cast<float>(v));
}

std::optional<cv::Point2f> followPatchForthAndBack(const GreyPyramid& from, const GreyPyramid& to,
                                                   const cv::Point2f& from_px,
                                                   const cv::Point2f& guess_px, int coarsest,
                                                   const FrontendOptions& options) {
    const auto there = followPatch(from, to, from_px, guess_px, {coarsest, 0}, options);
    if (!there) return std::nullopt;
    const auto back = followPatch(to, from, *there, from_px, {0, 0}, options);
    if (!back) return std::nullopt;
    const cv::Point2f d = *back - from_px;
    const double limit = options.kltForwardBackward_px;
    return d.dot(d) <= limit * limit ? there : std::nullopt;
}

}  // namespace djpete::frontend
