#include "measurement_model.h"

#include <algorithm>

namespace djpete::frontend {

using geometry::Mat3;
using geometry::Mat36;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

constexpr double kMinDepth = 0.1;          // metres in front of the camera
constexpr double kMinInverseDepth = 1e-5;  // 100 km: as good as infinity

double trackVariance(const FeatureTrack& track, const FrontendOptions& o) {
    return o.sigmaTrack_px * o.sigmaTrack_px +
           o.sigmaDrift_px * o.sigmaDrift_px * track.framesFollowed;
}

/// q.z = z * inverse depth of the anchor; true if z > kMinDepth.
bool inFront(const Vec3& q, double inverseDepth) { return q.z() > kMinDepth * inverseDepth; }

}  // namespace

std::optional<Vec2> predictPixel(const FeatureTrack& track, const SE3& T_odom_cam,
                                 const geometry::StereoCamera& camera) {
    const Vec3 q = track.scaledPoint(T_odom_cam.inverse() * track.T_odom_anchor);
    if (!inFront(q, track.anchorDepth.value) || q.z() < 0.05) return std::nullopt;
    return camera.project(q);
}

std::optional<Linearised> linearise(const FeatureTrack& track, const SE3& T_odom_cam,
                                    const geometry::StereoCamera& camera,
                                    const FrontendOptions& options) {
    const SE3 T_cam_anchor = T_odom_cam.inverse() * track.T_odom_anchor;
    const double rho = track.anchorDepth.value;
    const Vec3 q = track.scaledPoint(T_cam_anchor);
    if (!inFront(q, rho) || q.z() < 0.05) return std::nullopt;

    Linearised m;
    const double iz = 1.0 / q.z();
    const Vec2 uv = camera.project(q);
    m.residual.x() = track.now.px.x - uv.x();
    m.residual.y() = track.now.px.y - uv.y();
    const double variance = trackVariance(track, options);
    m.noise << variance, variance, 1.0;

    // h = (fx qx/qz + cx, fy qy/qz + cy, rho/qz)
    Mat3 dh_dq;
    dh_dq << camera.fx * iz, 0, -camera.fx * q.x() * iz * iz,  //
        0, camera.fy * iz, -camera.fy * q.y() * iz * iz,       //
        0, 0, -rho * iz * iz;
    // exp(-delta) p scaled by rho: dq = -rho d_rho + q x d_phi
    Mat36 dq;
    dq.leftCols<3>() = -rho * Mat3::Identity();
    dq.rightCols<3>() = geometry::skew(q);
    m.dPose = dh_dq * dq;
    m.dDepth = dh_dq * T_cam_anchor.translation();
    m.dDepth.z() += iz;
    // d/d delta of rho/qz with p = q/rho: 1/z changes with p only, which dq says in full.

    if (const auto& d = track.now.inverseDepth) {
        m.rows = 3;
        m.residual.z() = d->value - rho * iz;
        m.noise.z() = d->variance;
    } else {
        m.dPose.row(2).setZero();
        m.dDepth.z() = 0;
    }
    return m;
}

Mat3 information(const Linearised& m, double depthVariance) {
    // Sherman-Morrison: (N + s d d^T)^-1 = N^-1 - N^-1 d d^T N^-1 / (1/s + d^T N^-1 d)
    Vec3 w = m.noise.cwiseInverse();
    if (m.rows == 2) w.z() = 0;
    const Vec3 wd = w.cwiseProduct(m.dDepth);
    Mat3 out = w.asDiagonal();
    if (depthVariance > 0) out -= wd * wd.transpose() / (1.0 / depthVariance + m.dDepth.dot(wd));
    return out;
}

Vec3 residualBias(const FeatureTrack& track, const Linearised& m, const SE3& T_odom_cam,
                  const geometry::StereoCamera& camera) {
    const SE3 T_cam_anchor = T_odom_cam.inverse() * track.T_odom_anchor;
    Vec3 out =
        m.dPose * (T_cam_anchor.adjoint() * track.anchorPoseBias) - m.dDepth * track.depthBias;
    if (m.rows == 3 && camera.hasRight())
        out.z() -= track.now.stereoShare / (camera.fx * camera.baseline_m);
    return out;
}

void updateDepth(FeatureTrack& track, const SE3& T_odom_cam, const Mat6& poseCovariance,
                 const PoseBias& poseBias, const geometry::StereoCamera& camera,
                 const FrontendOptions& options) {
    const auto m = linearise(track, T_odom_cam, camera, options);
    if (!m) return;
    Mat3 S = m->dPose * poseCovariance * m->dPose.transpose();
    S += m->noise.asDiagonal();
    S += track.anchorDepth.variance * m->dDepth * m->dDepth.transpose();
    const Vec3 gain = track.anchorDepth.variance * S.ldlt().solve(m->dDepth);
    const Vec3 bias = residualBias(track, *m, T_odom_cam, camera) - m->dPose * poseBias;
    track.depthBias += gain.dot(bias);
    track.anchorDepth.value =
        std::max(kMinInverseDepth, track.anchorDepth.value + gain.dot(m->residual));
    track.anchorDepth.variance *= std::clamp(1.0 - gain.dot(m->dDepth), 1e-6, 1.0);
}

}  // namespace djpete::frontend
