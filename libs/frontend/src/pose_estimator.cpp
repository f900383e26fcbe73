#include "pose_estimator.h"

#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

#include "measurement_model.h"
#include "robust_weight.h"

namespace djpete::frontend {

using geometry::Mat3;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

/// Normal equations of one Gauss-Newton step.
struct NormalEquations {
    Mat6 H = Mat6::Zero();
    Vec6 b = Vec6::Zero();
};

NormalEquations accumulate(const std::vector<FeatureTrack>& tracks, const SE3& T_odom_cam,
                           const geometry::StereoCamera& camera, const FrontendOptions& options,
                           double scale) {
    NormalEquations n;
    for (const auto& track : tracks) {
        const auto m = linearise(track, T_odom_cam, camera, options);
        if (!m) continue;
        const Mat3 W = information(*m, track.anchorDepth.variance);
        const double chi2 = m->residual.dot(W * m->residual);
        const double w = robustWeight(chi2 / m->rows, scale);
        const geometry::Mat63 JtW = w * m->dPose.transpose() * W;
        n.H += JtW * m->dPose;
        n.b += JtW * m->residual;
    }
    return n;
}

/// Gauss-Newton until the step is below a tenth of a millimetre and of a milliradian.
SE3 refine(const std::vector<FeatureTrack>& tracks, SE3 T_odom_cam,
           const geometry::StereoCamera& camera, const FrontendOptions& options, double scale,
           int maxIterations) {
    for (int i = 0; i < maxIterations; ++i) {
        const auto n = accumulate(tracks, T_odom_cam, camera, options, scale);
        // A trace of damping keeps degenerate frames (all points far) solvable.
        Mat6 H = n.H;
        H.diagonal().array() += 1e-6 * (1.0 + n.H.diagonal().array());
        const Vec6 delta = H.ldlt().solve(n.b);
        if (!delta.allFinite()) break;
        T_odom_cam = (T_odom_cam * SE3::exp(delta)).normalised();
        if (delta.head<3>().norm() < 1e-5 && delta.tail<3>().norm() < 1e-6) break;
    }
    return T_odom_cam;
}

void classify(PoseEstimate& e, const std::vector<FeatureTrack>& tracks,
              const geometry::StereoCamera& camera, const FrontendOptions& options) {
    e.inlier.assign(tracks.size(), false);
    double sum = 0;
    int known = 0;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        const auto m = linearise(tracks[i], e.T_odom_cam, camera, options);
        if (!m) continue;
        const double chi2 =
            m->residual.dot(information(*m, tracks[i].anchorDepth.variance) * m->residual);
        if (chi2 > options.outlierChi2PerDof * m->rows) continue;
        e.inlier[i] = true;
        ++e.inlierCount;
        if (!tracks[i].depthKnown()) continue;  // its residual tells of depth, not of the pose
        sum += m->residual.head<2>().squaredNorm();
        ++known;
    }
    e.rms_px = known > 0 ? std::sqrt(sum / known) : 0;
}

/// The camera poses that see three tracks where they are measured.
std::vector<SE3> posesFromThree(const std::array<const FeatureTrack*, 3>& sample,
                                const geometry::StereoCamera& camera) {
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> rays;
    for (const auto* track : sample) {
        const Vec3 p = track->T_odom_anchor * (track->ray_anchor / track->anchorDepth.value);
        const Vec3 r = camera.ray({track->now.px.x, track->now.px.y});
        points.emplace_back(p.x(), p.y(), p.z());
        rays.emplace_back(r.x(), r.y());
    }
    std::vector<cv::Mat> rvecs, tvecs;
    cv::solveP3P(points, rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rvecs, tvecs,
                 cv::SOLVEPNP_P3P);
    std::vector<SE3> out;
    for (std::size_t i = 0; i < rvecs.size(); ++i) {
        const Vec3 phi(rvecs[i].at<double>(0), rvecs[i].at<double>(1), rvecs[i].at<double>(2));
        const Vec3 t(tvecs[i].at<double>(0), tvecs[i].at<double>(1), tvecs[i].at<double>(2));
        if (!phi.allFinite() || !t.allFinite()) continue;
        out.push_back(SE3(geometry::so3Exp(phi), t).inverse());
    }
    return out;
}

}  // namespace

PoseEstimate estimatePose(const std::vector<FeatureTrack>& tracks, const SE3& T_odom_cam,
                          const geometry::StereoCamera& camera, const FrontendOptions& options) {
    PoseEstimate e;
    e.T_odom_cam = T_odom_cam;
    for (const double widening : {8.0, 3.0}) {
        e.T_odom_cam =
            refine(tracks, e.T_odom_cam, camera, options, widening * options.robustScale, 3);
    }
    e.T_odom_cam = refine(tracks, e.T_odom_cam, camera, options, options.robustScale, 10);
    classify(e, tracks, camera, options);
    Mat6 H = accumulate(tracks, e.T_odom_cam, camera, options, options.robustScale).H;
    H.diagonal().array() += 1e-3;
    e.covariance = H.ldlt().solve(Mat6::Identity());
    return e;
}

PoseEstimate estimatePoseFromSamples(const std::vector<FeatureTrack>& tracks,
                                     const SE3& fallback_T_odom_cam,
                                     const geometry::StereoCamera& camera,
                                     const FrontendOptions& options, uint64_t seed) {
    std::vector<const FeatureTrack*> known;
    for (const auto& t : tracks) {
        if (t.depthKnown()) known.push_back(&t);
    }
    SE3 best = fallback_T_odom_cam;
    int bestCount = -1;
    std::mt19937_64 random(seed);
    const auto draw = [&] { return known[random() % known.size()]; };
    for (int i = 0; known.size() >= 6 && i < options.ransacIterations; ++i) {
        const std::array<const FeatureTrack*, 3> sample{draw(), draw(), draw()};
        if (sample[0] == sample[1] || sample[1] == sample[2] || sample[0] == sample[2]) continue;
        for (const auto& T_odom_cam : posesFromThree(sample, camera)) {
            PoseEstimate e;
            e.T_odom_cam = T_odom_cam;
            classify(e, tracks, camera, options);
            if (e.inlierCount > bestCount) {
                bestCount = e.inlierCount;
                best = T_odom_cam;
            }
        }
    }
    return estimatePose(tracks, best, camera, options);
}

}  // namespace djpete::frontend
