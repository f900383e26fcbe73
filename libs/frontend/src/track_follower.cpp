#include "track_follower.h"

#include <cmath>

#include "measurement_model.h"

namespace djpete::frontend {

namespace {

using Tracks = std::vector<FeatureTrack>;

Tracks followFrom(const Tracks& tracks, const GreyPyramid& base, const GreyPyramid& next,
                  const std::vector<cv::Point2f>& guess_px, int levels,
                  const FrontendOptions& options) {
    std::vector<cv::Point2f> from;
    from.reserve(tracks.size());
    for (const auto& t : tracks) from.push_back(t.now.px);
    const auto found = followPatches(base, next, from, guess_px, levels, options);
    Tracks out;
    out.reserve(tracks.size());
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        if (!found[i]) continue;
        out.push_back(tracks[i]);
        out.back().startFrame(*found[i]);
    }
    return out;
}

std::vector<cv::Point2f> predictedPixels(const Tracks& tracks, const geometry::SE3& T_odom_cam,
                                         const geometry::StereoCamera& camera) {
    std::vector<cv::Point2f> out;
    out.reserve(tracks.size());
    for (const auto& t : tracks) {
        const auto uv = predictPixel(t, T_odom_cam, camera);
        out.push_back(uv && camera.contains(*uv)
                          ? cv::Point2f(static_cast<float>(uv->x()), static_cast<float>(uv->y()))
                          : t.now.px);
    }
    return out;
}

/// Tracks are in order of age, so the first that claims a place is the older.
void dropExcludedAndDouble(Tracks& tracks, const cv::Size& size, const cv::Mat& exclusion,
                           const FrontendOptions& options) {
    cv::Mat taken = exclusion.empty() ? cv::Mat::zeros(size, CV_8U) : exclusion.clone();
    const int r = std::max(1, static_cast<int>(options.minDistance_px / 3));
    Tracks kept;
    kept.reserve(tracks.size());
    for (auto& t : tracks) {
        const cv::Point at(static_cast<int>(std::lround(t.now.px.x)),
                           static_cast<int>(std::lround(t.now.px.y)));
        if (taken.at<uint8_t>(at) != 0) continue;
        const cv::Rect box(at.x - r, at.y - r, 2 * r + 1, 2 * r + 1);
        taken(box & cv::Rect(0, 0, size.width, size.height)).setTo(255);
        kept.push_back(std::move(t));
    }
    tracks = std::move(kept);
}

}  // namespace

FollowResult followTracks(const Tracks& tracks, const GreyPyramid& base, const GreyPyramid& next,
                          const std::optional<geometry::SE3>& T_odom_cam_predicted,
                          const geometry::StereoCamera& camera, const cv::Mat& exclusion,
                          const FrontendOptions& options) {
    FollowResult out;
    if (T_odom_cam_predicted) {
        out.tracks =
            followFrom(tracks, base, next, predictedPixels(tracks, *T_odom_cam_predicted, camera),
                       options.kltPredictedLevels, options);
    }
    const double enough = options.kltMinPredictedRatio * static_cast<double>(tracks.size());
    if (!T_odom_cam_predicted || static_cast<double>(out.tracks.size()) < enough) {
        out.usedFullSearch = true;
        std::vector<cv::Point2f> stay;
        for (const auto& t : tracks) stay.push_back(t.now.px);
        auto wide = followFrom(tracks, base, next, stay, options.kltLevels, options);
        if (wide.size() > out.tracks.size()) out.tracks = std::move(wide);
    }
    dropExcludedAndDouble(out.tracks, next.grey.size(), exclusion, options);
    return out;
}

}  // namespace djpete::frontend
