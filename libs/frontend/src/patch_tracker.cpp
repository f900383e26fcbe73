#include "patch_tracker.h"

#include <opencv2/video/tracking.hpp>

namespace djpete::frontend {

namespace {

cv::TermCriteria criteria(const FrontendOptions& o) {
    return {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, o.kltIterations, 0.01};
}

bool inside(const cv::Point2f& p, const cv::Size& size, int border) {
    const auto b = static_cast<float>(border);
    return p.x >= b && p.y >= b && p.x <= static_cast<float>(size.width - 1) - b &&
           p.y <= static_cast<float>(size.height - 1) - b;
}

}  // namespace

GreyPyramid buildPyramid(const cv::Mat& grey, const FrontendOptions& options) {
    GreyPyramid out;
    out.grey = grey;
    cv::buildOpticalFlowPyramid(grey, out.levels, {options.kltWindow_px, options.kltWindow_px},
                                options.kltLevels, true);
    return out;
}

std::vector<std::optional<cv::Point2f>> followPatches(
    const GreyPyramid& from, const GreyPyramid& to, const std::vector<cv::Point2f>& from_px,
    const std::vector<cv::Point2f>& guess_px, int levelsAboveFull, const FrontendOptions& options) {
    std::vector<std::optional<cv::Point2f>> out(from_px.size());
    if (from_px.empty()) return out;
    const cv::Size window(options.kltWindow_px, options.kltWindow_px);
    constexpr double kMinEigenvalue = 1e-4;

    std::vector<cv::Point2f> there = guess_px;
    std::vector<uint8_t> ok;
    cv::calcOpticalFlowPyrLK(from.levels, to.levels, from_px, there, ok, cv::noArray(), window,
                             levelsAboveFull, criteria(options), cv::OPTFLOW_USE_INITIAL_FLOW,
                             kMinEigenvalue);

    std::vector<std::size_t> index;
    std::vector<cv::Point2f> start, back;
    for (std::size_t i = 0; i < from_px.size(); ++i) {
        if (!ok[i] || !inside(there[i], to.grey.size(), options.border_px)) continue;
        index.push_back(i);
        start.push_back(there[i]);
        back.push_back(from_px[i]);
    }
    if (index.empty()) return out;
    cv::calcOpticalFlowPyrLK(to.levels, from.levels, start, back, ok, cv::noArray(), window, 0,
                             criteria(options), cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
    const double limit2 = options.kltForwardBackward_px * options.kltForwardBackward_px;
    for (std::size_t k = 0; k < index.size(); ++k) {
        const cv::Point2f d = back[k] - from_px[index[k]];
        if (ok[k] && d.dot(d) <= limit2) out[index[k]] = start[k];
    }
    return out;
}

}  // namespace djpete::frontend
