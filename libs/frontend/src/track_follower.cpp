#include "track_follower.h"

#include <algorithm>
#include <cmath>

#include "measurement_model.h"
#include "patch_alignment.h"

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

/// How a step of one pixel about the track in the new image maps to its first image; nothing if the
/// surface is seen too differently there.
std::optional<geometry::Mat2> anchorStepsPerPixel(const FeatureTrack& track,
                                                  const geometry::SE3& T_odom_cam,
                                                  const geometry::StereoCamera& camera) {
    const geometry::SE3 T_cam_anchor = T_odom_cam.inverse() * track.T_odom_anchor;
    const geometry::Vec3 q = track.scaledPoint(T_cam_anchor);
    if (q.z() < 0.05) return std::nullopt;
    geometry::Mat23 duv_dq;
    duv_dq << camera.fx / q.z(), 0, -camera.fx * q.x() / (q.z() * q.z()),  //
        0, camera.fy / q.z(), -camera.fy * q.y() / (q.z() * q.z());
    Eigen::Matrix<double, 3, 2> dq_danchor;
    dq_danchor.col(0) = T_cam_anchor.rotation().col(0) / camera.fx;
    dq_danchor.col(1) = T_cam_anchor.rotation().col(1) / camera.fy +
                        track.inverseDepthPerRow * T_cam_anchor.translation();
    const geometry::Mat2 grown = duv_dq * dq_danchor;
    const double area = grown.determinant();
    if (!(area > 0.4) || area > 6.0) return std::nullopt;
    return grown.inverse();
}

/// Puts the track where its first patch, warped as motion and depth say, matches best: so the place
/// does not slide away frame by frame. False if the patch is not there any more.
bool refineOnFirstPatch(FeatureTrack& track, const cv::Mat& grey, const geometry::SE3& T_odom_cam,
                        const geometry::StereoCamera& camera, const FrontendOptions& options) {
    if (!track.depthKnown() || track.anchorGrey.empty()) return true;
    const auto steps = anchorStepsPerPixel(track, T_odom_cam, camera);
    if (!steps) return true;
    const geometry::Vec2 first = camera.project(track.ray_anchor);
    constexpr PlacePrior kFree{100.0, 1e-3};
    const auto patch = PatchTemplate::from(track.anchorGrey, first.x(), first.y(), *steps, kFree);
    if (!patch) return true;
    PatchPlace start;
    start.u_px = track.now.px.x;
    start.v_px = track.now.px.y;
    const auto place = patch->align(grey, start, 1.5);
    if (!place || place->correlation < options.kltMinCorrelation) return false;
    track.now.px = {static_cast<float>(place->u_px), static_cast<float>(place->v_px)};
    return true;
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
    if (T_odom_cam_predicted && !out.usedFullSearch) {
        const auto lost = [&](FeatureTrack& t) {
            return !refineOnFirstPatch(t, next.grey, *T_odom_cam_predicted, camera, options);
        };
        out.tracks.erase(std::remove_if(out.tracks.begin(), out.tracks.end(), lost),
                         out.tracks.end());
    }
    dropExcludedAndDouble(out.tracks, next.grey.size(), exclusion, options);
    return out;
}

}  // namespace djpete::frontend
