#include "track_follower.h"

#include <algorithm>
#include <cmath>

#include "anchor_patch.h"
#include "mark_taken.h"
#include "measurement_model.h"
#include "ordered_parallel.h"
#include "pose_estimator.h"

namespace djpete::frontend {

namespace {

using Tracks = std::vector<FeatureTrack>;

/// Tracks of the rough motion.
constexpr std::size_t kScouts = 160;
/// Pixels; scouts are followed down to half size only.
constexpr double kScoutSigma_px = 0.7;
constexpr std::size_t kLeastScouts = 12;
/// Levels above full size on which scouts are sought first, and the share that must be found and
/// agree there.
constexpr int kNearLevels = 2;
constexpr double kNearShare = 0.7;
/// Levels above full size for tracks whose depth, and so whose place, is not known.
constexpr int kLevelsUnknownDepth = 2;

cv::Point2f predictedPixel(const FeatureTrack& t, const geometry::SE3& T_odom_cam,
                           const geometry::StereoCamera& camera) {
    const auto uv = predictPixel(t, T_odom_cam, camera);
    if (!uv || !camera.contains(*uv)) return t.now.px;
    return {static_cast<float>(uv->x()), static_cast<float>(uv->y())};
}

/// Calls find(track) -> optional pixel for all, side by side; keeps those found, in their order.
template <class Find>
Tracks keepFound(const Tracks& tracks, const Find& find) {
    std::vector<std::optional<cv::Point2f>> found(tracks.size());
    forEachItem(tracks.size(), [&](std::size_t i) { found[i] = find(tracks[i]); });
    Tracks out;
    out.reserve(tracks.size());
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        if (!found[i]) continue;
        out.push_back(tracks[i]);
        out.back().startFrame(*found[i]);
    }
    return out;
}

/// About kScouts tracks of known depth, spread as the tracks are.
Tracks chooseScouts(const Tracks& tracks) {
    std::vector<const FeatureTrack*> known;
    for (const auto& t : tracks) {
        if (t.depthKnown()) known.push_back(&t);
    }
    Tracks out;
    const std::size_t n = std::min(known.size(), kScouts);
    for (std::size_t i = 0; i < n; ++i) out.push_back(*known[i * known.size() / n]);
    return out;
}

/// The motion that `scouts` show, or nothing if they do not agree.
std::optional<geometry::SE3> agreedMotion(const Tracks& scouts, const geometry::SE3& T_start,
                                          const geometry::StereoCamera& camera,
                                          const FrontendOptions& options, double share,
                                          std::optional<uint64_t> seedOfSamples) {
    const double enough =
        std::max<double>(kLeastScouts, share * static_cast<double>(scouts.size()));
    if (scouts.size() < kLeastScouts) return std::nullopt;
    auto estimate = estimatePose(scouts, T_start, camera, options);
    if (estimate.inlierCount < enough && seedOfSamples)
        estimate = estimatePoseFromSamples(scouts, T_start, camera, options, *seedOfSamples);
    if (estimate.inlierCount < enough) return std::nullopt;
    return estimate.T_odom_cam;
}

/// Seeks the scouts near where they are expected, and if they do not agree there, far around.
std::optional<geometry::SE3> roughMotion(const Tracks& tracks, const GreyPyramid& base,
                                         const GreyPyramid& next, const geometry::SE3& T_start,
                                         const geometry::StereoCamera& camera,
                                         FrontendOptions options, uint64_t seed) {
    const Tracks scouts = chooseScouts(tracks);
    const auto seek = [&](int coarsest) {
        const LevelRange levels{coarsest, std::min(1, options.kltLevels)};
        return keepFound(scouts, [&](const FeatureTrack& t) {
            return followPatch(base, next, t.now.px, predictedPixel(t, T_start, camera), levels,
                               options);
        });
    };
    options.sigmaTrack_px = std::max(options.sigmaTrack_px, kScoutSigma_px);
    const Tracks near = seek(std::min(kNearLevels, options.kltLevels));
    if (static_cast<double>(near.size()) >= kNearShare * static_cast<double>(scouts.size())) {
        if (auto T = agreedMotion(near, T_start, camera, options, kNearShare, std::nullopt))
            return T;
    }
    return agreedMotion(seek(options.kltLevels), T_start, camera, options, options.minInlierRatio,
                        seed);
}

/// Tracks are in order of age, so the first that claims a place is the older.
void dropExcludedAndDouble(Tracks& tracks, const cv::Size& size, const cv::Mat& exclusion,
                           const FrontendOptions& options) {
    cv::Mat taken = exclusion.empty() ? cv::Mat::zeros(size, CV_8U) : exclusion.clone();
    const int r = std::max(1, static_cast<int>(options.minDistance_px / 3));
    Tracks kept;
    kept.reserve(tracks.size());
    const cv::Rect inner(options.border_px, options.border_px, size.width - 2 * options.border_px,
                         size.height - 2 * options.border_px);
    for (auto& t : tracks) {
        const cv::Point at(static_cast<int>(std::lround(t.now.px.x)),
                           static_cast<int>(std::lround(t.now.px.y)));
        if (!inner.contains(at) || taken.at<uint8_t>(at) != 0) continue;
        markTaken(taken, at.x, at.y, r);
        kept.push_back(std::move(t));
    }
    tracks = std::move(kept);
}

}  // namespace

FollowResult followTracks(const Tracks& tracks, const GreyPyramid& base, const GreyPyramid& next,
                          const geometry::SE3& T_odom_cam_start,
                          const geometry::StereoCamera& camera, const cv::Mat& exclusion,
                          const FrontendOptions& options, uint64_t seed) {
    FollowResult out;
    const auto rough = roughMotion(tracks, base, next, T_odom_cam_start, camera, options, seed);
    out.usedFullSearch = !rough;
    out.T_odom_cam = rough.value_or(T_odom_cam_start);
    const geometry::SE3 T_cam_odom = out.T_odom_cam.inverse();
    out.tracks = keepFound(tracks, [&](const FeatureTrack& t) -> std::optional<cv::Point2f> {
        if (rough) {
            const auto place = findFirstPatch(t, next.grey(), T_cam_odom, camera, options);
            if (place.outcome != AnchorOutcome::kNoPatch) return place.px;
        }
        return followPatchForthAndBack(base, next, t.now.px,
                                       predictedPixel(t, out.T_odom_cam, camera),
                                       rough ? kLevelsUnknownDepth : options.kltLevels, options);
    });
    dropExcludedAndDouble(out.tracks, next.grey().size(), exclusion, options);
    return out;
}

}  // namespace djpete::frontend
