#include "anchor_patch.h"

#include <opencv2/imgproc.hpp>

#include "measurement_model.h"
#include "patch_alignment.h"

namespace djpete::frontend {

namespace {

/// A patch of 11 pixels and its frame, seen twice as near.
constexpr int kReach_px = 2 * (kHalf + 1) + 2;

/// How a step of one pixel about the track in the new image maps to its first image; nothing if the
/// surface is seen too differently there.
std::optional<geometry::Mat2> anchorStepsPerPixel(const FeatureTrack& track,
                                                  const geometry::SE3& T_cam_anchor,
                                                  const geometry::Vec3& q,
                                                  const geometry::StereoCamera& camera) {
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

}  // namespace

cv::Mat anchorPatchAt(const cv::Mat& grey, const cv::Point2f& px) {
    const cv::Rect around(static_cast<int>(px.x) - kReach_px, static_cast<int>(px.y) - kReach_px,
                          2 * kReach_px + 1, 2 * kReach_px + 1);
    cv::Mat out;
    const cv::Rect inside = around & cv::Rect(0, 0, grey.cols, grey.rows);
    cv::copyMakeBorder(grey(inside), out, inside.y - around.y, around.br().y - inside.br().y,
                       inside.x - around.x, around.br().x - inside.br().x,
                       cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
    return out;
}

AnchorPlace findFirstPatch(const FeatureTrack& track, const cv::Mat& grey,
                           const geometry::SE3& T_cam_odom, const geometry::StereoCamera& camera,
                           const FrontendOptions& options) {
    AnchorPlace out;
    if (!track.depthKnown() || track.anchorPatch.empty()) return out;
    const geometry::SE3 T_cam_anchor = T_cam_odom * track.T_odom_anchor;
    const geometry::Vec3 q = track.scaledPoint(T_cam_anchor);
    if (q.z() < 0.05) return out;
    const auto steps = anchorStepsPerPixel(track, T_cam_anchor, q, camera);
    if (!steps) return out;
    constexpr PlacePrior kFree{100.0, 0.0};
    const auto patch =
        PatchTemplate::warped(track.anchorPatch, kReach_px, kReach_px, *steps, kFree);
    if (!patch) return out;
    out.outcome = AnchorOutcome::kLost;
    const geometry::Vec2 predicted = camera.project(q);
    PatchPlace start;
    start.u_px = predicted.x();
    start.v_px = predicted.y();
    constexpr SearchReach kReach{3.0, 3.0};
    const auto place = patch->align(grey, start, kReach);
    if (!place || place->correlation < options.kltMinCorrelation) return out;
    out.outcome = AnchorOutcome::kFound;
    out.px.emplace(static_cast<float>(place->u_px), static_cast<float>(place->v_px));
    return out;
}

}  // namespace djpete::frontend
