#include "stereo_calibrator.h"

#include <algorithm>
#include <cmath>

#include "measurement_model.h"
#include "robust_weight.h"

namespace djpete::frontend {

using geometry::Mat3;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

/// Standard deviations before any match, px: a good rectification errs by some tenths of a pixel
/// within the image, where x is within 0.9 and y within 0.3.
RowTerms rowPrior_px() { return (RowTerms() << 0.5, 0.5, 1.0, 3.0, 0.5, 3.0).finished(); }
constexpr double kDisparityPrior_px = 0.4;

constexpr double kRowSigma_px = 0.3, kRowOutlier_px = 1.0;
/// Share of the information that counts: neighbours and successive frames err alike.
constexpr double kIndependent = 0.1;

}  // namespace

StereoCalibrator::StereoCalibrator(const FrontendOptions& options)
    : enabled_(options.stereoCalibrate),
      rowInformation_(rowPrior_px().cwiseAbs2().cwiseInverse().asDiagonal()),
      disparityInformation_(1.0 / (kDisparityPrior_px * kDisparityPrior_px)) {}

void StereoCalibrator::learnRows(const std::vector<FeatureTrack>& tracks,
                                 const geometry::StereoCamera& camera) {
    if (!enabled_) return;
    const double weight = kIndependent / (kRowSigma_px * kRowSigma_px);
    for (const auto& t : tracks) {
        if (!t.uRight_px) continue;
        const Vec3 ray = camera.ray({t.now.px.x, t.now.px.y});
        if (std::abs(t.rowDifference_px - calibration_.rowAt(ray)) > kRowOutlier_px) continue;
        const RowTerms terms = rowTerms(ray);
        rowInformation_ += weight * terms * terms.transpose();
        rowSum_ += weight * t.rowDifference_px * terms;
    }
    calibration_.row_px = rowInformation_.ldlt().solve(rowSum_);
}

void StereoCalibrator::learnDisparity(std::vector<FeatureTrack>& inliers, const SE3& T_odom_cam,
                                      const geometry::StereoCamera& camera,
                                      const FrontendOptions& options) {
    if (!enabled_ || !camera.hasRight()) return;
    // r + g change - J step is least for the change and any step of the pose.
    Mat6 JJ = Mat6::Zero();
    Vec6 Jg = Vec6::Zero(), Jr = Vec6::Zero();
    double gg = 0, gr = 0;
    for (const auto& t : inliers) {
        const auto m = linearise(t, T_odom_cam, camera, options);
        if (!m) continue;
        Mat3 W = information(*m, t.anchorDepth.variance);
        W *= robustWeight(m->residual.dot(W * m->residual) / m->rows, options.robustScale);
        const Vec3 g = residualBias(t, *m, T_odom_cam, camera);
        const geometry::Mat63 JtW = m->dPose.transpose() * W;
        JJ += JtW * m->dPose;
        Jg += JtW * g;
        Jr += JtW * m->residual;
        gg += g.dot(W * g);
        gr += g.dot(W * m->residual);
    }
    JJ.diagonal().array() += 1e-3;
    const PoseBias bias = JJ.ldlt().solve(Jg);
    const double information = kIndependent * std::max(0.0, gg - Jg.dot(bias));
    const double gradient = kIndependent * (gr - Jr.dot(bias));
    const double change_px = -gradient / (disparityInformation_ + information);
    if (!bias.allFinite() || !std::isfinite(change_px)) return;
    disparityInformation_ += information;
    poseBias_ = bias;
    calibration_.disparity_px += change_px;
    correct(inliers, change_px, T_odom_cam, camera);
}

void StereoCalibrator::correct(std::vector<FeatureTrack>& tracks, double change_px,
                               const SE3& T_odom_cam, const geometry::StereoCamera& camera) const {
    const SE3 T_odom_corrected = T_odom_cam * SE3::exp(-poseBias_ * change_px);
    const SE3 T_cam_odom = T_odom_cam.inverse();
    const double fb = camera.fx * camera.baseline_m;
    for (auto& t : tracks) {
        // The current camera stays where it is; the anchor moves against it.
        t.T_odom_anchor = (T_odom_corrected * (T_cam_odom * t.T_odom_anchor) *
                           SE3::exp(t.anchorPoseBias * change_px))
                              .normalised();
        t.anchorDepth.value = std::max(1e-5, t.anchorDepth.value + t.depthBias * change_px);
        if (t.now.inverseDepth) t.now.inverseDepth->value -= t.now.stereoShare * change_px / fb;
        if (t.uRight_px) *t.uRight_px += static_cast<float>(change_px);
    }
}

}  // namespace djpete::frontend
