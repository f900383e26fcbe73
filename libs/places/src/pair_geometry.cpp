#include "pair_geometry.h"

#include <algorithm>
#include <cmath>

#include "djpete/geometry/point_residuals.h"

namespace djpete::places {

using geometry::Mat3;
using geometry::Mat36;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;
using Corner = PlaceView::Corner;

namespace {

/// A corner found elsewhere by one pixel has another depth: on a road seen from this height, its
/// inverse depth changes by 1 / (height * f).
constexpr double kCameraHeight_m = 1.65;

double squared(double x) { return x * x; }

/// Variances of (u, v, 1/z) of a corner with a point.
Vec3 variances(const Corner& corner, const geometry::StereoCamera& camera,
               const MatchOptions& options) {
    const double floor = options.sigma_px / (kCameraHeight_m * camera.fy);
    return {squared(corner.sigma_px), squared(corner.sigma_px),
            squared(corner.inverseDepthSigma) + squared(floor)};
}

/// Of (u, v, 1/z) by the point.
Mat3 projectionJacobian(const Vec3& p_cam, const geometry::StereoCamera& camera) {
    const double w = 1 / p_cam.z();
    Mat3 D;
    D << camera.fx * w, 0, -camera.fx * p_cam.x() * w * w,  //
        0, camera.fy * w, -camera.fy * p_cam.y() * w * w,   //
        0, 0, -w * w;
    return D;
}

/// Of the point by (u, v, 1/z).
Mat3 pointJacobian(const Vec3& p_cam, const geometry::StereoCamera& camera) {
    Mat3 J;
    J << p_cam.z() / camera.fx, 0, -p_cam.x() * p_cam.z(),  //
        0, p_cam.z() / camera.fy, -p_cam.y() * p_cam.z(),   //
        0, 0, -p_cam.z() * p_cam.z();
    return J;
}

/// Transfers `from`, which has a point, into the view of `to`. `J_p`: how the point in `to`
/// changes by the perturbation of the pose.
std::optional<Transfer> transferTo(const Corner& from, const geometry::StereoCamera& fromCamera,
                                   const Corner& to, const geometry::StereoCamera& toCamera,
                                   const SE3& T_to_from, const Vec3& p_to, const Mat36& J_p,
                                   const MatchOptions& options) {
    if (!(p_to.z() > geometry::kMinDepth_m)) return std::nullopt;
    const Mat3 D = projectionJacobian(p_to, toCamera);
    const Mat3 G = D * T_to_from.rotation() * pointJacobian(*from.p_cam, fromCamera);
    Mat3 S = G * variances(from, fromCamera, options).asDiagonal() * G.transpose();
    const double corner = squared(to.sigma_px) + squared(options.sigma_px);
    S(0, 0) += corner;
    S(1, 1) += corner;
    Transfer t;
    const geometry::Vec2 predicted = toCamera.project(p_to);
    t.error << to.px - predicted, 0;
    t.jacobian = D * J_p;
    if (to.p_cam) {
        t.rows = 3;
        t.error.z() = 1 / to.p_cam->z() - 1 / p_to.z();
        S(2, 2) += variances(to, toCamera, options).z();
        t.information = S.inverse();
    } else {
        t.information.setZero();
        t.information.topLeftCorner<2, 2>() = S.topLeftCorner<2, 2>().inverse();
    }
    return t;
}

Mat36 perturbed(const Mat3& byRho, const Mat3& byPhi) {
    Mat36 J;
    J << byRho, byPhi;
    return J;
}

/// Cauchy's weight.
double weightOf(double chi2, double scale2) { return 1 / (1 + chi2 / scale2); }

}  // namespace

std::optional<Transfer> transfer(const ViewPair& views, const CornerPair& pair, const SE3& T_a_b) {
    const Corner& a = views.a.corners[pair.a];
    const Corner& b = views.b.corners[pair.b];
    // With both points the transfer either way says the same, to first order.
    if (a.p_cam) {
        const SE3 T_b_a = T_a_b.inverse();
        const Vec3 p_b = T_b_a * *a.p_cam;
        return transferTo(a, views.a.camera, b, views.b.camera, T_b_a, p_b,
                          perturbed(-Mat3::Identity(), geometry::skew(p_b)), views.options);
    }
    if (!b.p_cam) return std::nullopt;
    const Mat3& R = T_a_b.rotation();
    return transferTo(b, views.b.camera, a, views.a.camera, T_a_b, T_a_b * *b.p_cam,
                      perturbed(R, -R * geometry::skew(*b.p_cam)), views.options);
}

std::vector<CornerPair> agreeing(const ViewPair& views, const std::vector<CornerPair>& pairs,
                                 const SE3& T_a_b) {
    std::vector<CornerPair> out;
    for (const auto& pair : pairs) {
        const auto t = transfer(views, pair, T_a_b);
        if (t && t->chi2() <= views.options.maxChi2) out.push_back(pair);
    }
    return out;
}

RefinedPose refinePose(const ViewPair& views, const std::vector<CornerPair>& pairs,
                       const SE3& T_a_b, double widening) {
    constexpr int kIterations = 12;
    constexpr double kScale2 = 3.0;  // chi2 of an ordinary pair
    RefinedPose out;
    out.T_a_b = T_a_b;
    for (int i = 0; i < kIterations; ++i) {
        Mat6 H = Mat6::Zero();
        Vec6 g = Vec6::Zero();
        for (const auto& pair : pairs) {
            const auto t = transfer(views, pair, out.T_a_b);
            if (!t) continue;
            const double w = weightOf(t->chi2(), kScale2 * widening * widening);
            const geometry::Mat63 JtW = w * t->jacobian.transpose() * t->information;
            H += JtW * t->jacobian;
            g += JtW * t->error;
        }
        H.diagonal().array() += 1e-6 * (1.0 + H.diagonal().array());
        const Vec6 delta = H.ldlt().solve(g);
        if (!delta.allFinite()) break;
        out.T_a_b = (out.T_a_b * SE3::exp(delta)).normalised();
        if (widening <= 1 && delta.head<3>().norm() < 1e-4 && delta.tail<3>().norm() < 1e-5) break;
        widening = std::max(1.0, 0.5 * widening);
    }
    out.agreeing = agreeing(views, pairs, out.T_a_b);
    for (const auto& pair : out.agreeing) {
        const auto t = transfer(views, pair, out.T_a_b);
        out.information += t->jacobian.transpose() * t->information * t->jacobian;
    }
    out.information /= views.options.dependence;
    return out;
}

}  // namespace djpete::places
