#include "djpete/geometry/residuals.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "djpete_test/numeric_jacobian.h"
#include "djpete_test/synthetic_world.h"

namespace djpete::geometry {
namespace {

using djpete_test::numericJacobian;

std::mt19937 generator(unsigned seed) { return std::mt19937(seed); }

Vec6 randomTwist(std::mt19937& rng, double scale) {
    std::uniform_real_distribution<double> u(-scale, scale);
    Vec6 xi;
    for (int i = 0; i < 6; ++i) xi[i] = u(rng);
    return xi;
}

/// Twists at which every Jacobian must hold: identity, 1e-8 and random ones.
std::vector<Vec6> twists(unsigned seed) {
    std::vector<Vec6> out{Vec6::Zero(), 1e-8 * Vec6::Ones()};
    std::mt19937 rng = generator(seed);
    for (int k = 0; k < 8; ++k) out.push_back(randomTwist(rng, 1.2));
    return out;
}

Mat6 someInformation() {
    std::mt19937 rng = generator(3);
    std::uniform_real_distribution<double> u(-1, 1);
    Mat6 A;
    for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = u(rng);
    return A * A.transpose() + 0.5 * Mat6::Identity();
}

Mat6 someWhitening() { return *sqrtInformation<6>(someInformation()); }

TEST(SqrtInformation, WhitensToTheInformationNorm) {
    const Mat6 information = someInformation();
    const auto W = sqrtInformation<6>(information);
    ASSERT_TRUE(W);
    for (const Vec6& e : twists(4)) {
        EXPECT_NEAR((*W * e).squaredNorm(), e.dot(information * e), 1e-12 * (1 + e.squaredNorm()));
    }
}

TEST(SqrtInformation, TakesSemiDefiniteAndRefusesWhatIsNoInformation) {
    Mat3 semi = Vec3(4, 0, 1).asDiagonal();
    const auto W = sqrtInformation<3>(semi);
    ASSERT_TRUE(W);
    EXPECT_LT((W->transpose() * *W - semi).norm(), 1e-14);
    EXPECT_FALSE(sqrtInformation<3>(Mat3(Vec3(4, -1, 1).asDiagonal())));
    Mat3 skewed = Mat3::Identity();
    skewed(0, 1) = 0.5;
    EXPECT_FALSE(sqrtInformation<3>(skewed));
    EXPECT_FALSE(sqrtInformation<3>(Mat3::Constant(std::nan(""))));
}

TEST(RelativePoseResidual, VanishesWhereTheMeasurementHolds) {
    for (const Vec6& a : twists(5)) {
        for (const Vec6& b : twists(6)) {
            const SE3 A = SE3::exp(a), B = SE3::exp(b);
            const RelativePoseResidual r(A.inverse() * B, someWhitening());
            EXPECT_LT(r(A, B).norm(), 1e-12);
        }
    }
}

TEST(CameraObjectResidual, IsTheWhitenedLogarithm) {
    Vec6 e;
    e << 0.1, -0.2, 0.3, 0.2, 0.1, -0.3;
    const SE3 T_world_cam = SE3::exp(Vec6::Ones()), Z = SE3::exp(-0.5 * Vec6::Ones());
    const CameraObjectResidual r(Z, someWhitening());
    const Vec6 value = r(T_world_cam, T_world_cam * Z * SE3::exp(e));
    EXPECT_LT((value - someWhitening() * e).norm(), 1e-12);
    EXPECT_NEAR(value.squaredNorm(), e.dot(someInformation() * e), 1e-12);
}

TEST(CameraObjectResidual, JacobiansAgreeWithCentralDifferences) {
    const auto cams = twists(7), errors = twists(8), measurements = twists(9);
    for (std::size_t k = 0; k < cams.size(); ++k) {
        const SE3 T_world_cam = SE3::exp(cams[k]), Z = SE3::exp(measurements[k]);
        const SE3 T_world_obj = T_world_cam * Z * SE3::exp(errors[k]);
        const CameraObjectResidual r(Z, someWhitening());
        Mat6 J_cam, J_obj;
        r(T_world_cam, T_world_obj, &J_cam, &J_obj);
        const Mat6 n_cam =
            numericJacobian<6>([&](const SE3& T) { return r(T, T_world_obj); }, T_world_cam);
        const Mat6 n_obj =
            numericJacobian<6>([&](const SE3& T) { return r(T_world_cam, T); }, T_world_obj);
        EXPECT_LT((J_cam - n_cam).cwiseAbs().maxCoeff(), 1e-7) << k;
        EXPECT_LT((J_obj - n_obj).cwiseAbs().maxCoeff(), 1e-7) << k;
    }
}

TEST(CameraObjectResidual, AgreesWithThePapersLeftJacobians) {
    // Paper: de/d(left of T_wo) = Jr^-1(e) Ad(T_wo^-1), camera the same with a minus sign;
    // J_left = J_right Ad(T)^-1.
    const auto cams = twists(10), errors = twists(11), measurements = twists(12);
    for (std::size_t k = 0; k < cams.size(); ++k) {
        const SE3 T_world_cam = SE3::exp(cams[k]), Z = SE3::exp(measurements[k]);
        const SE3 T_world_obj = T_world_cam * Z * SE3::exp(errors[k]);
        const CameraObjectResidual r(Z, Mat6::Identity());
        Mat6 J_cam, J_obj;
        const Vec6 e = r(T_world_cam, T_world_obj, &J_cam, &J_obj);
        const Mat6 left = se3RightJacobianInverse(e) * T_world_obj.inverse().adjoint();
        EXPECT_LT((J_obj * T_world_obj.inverse().adjoint() - left).norm(), 1e-10);
        EXPECT_LT((J_cam * T_world_cam.inverse().adjoint() + left).norm(), 1e-10);
    }
}

TEST(PosePriorResidual, JacobianAgreesWithCentralDifferences) {
    for (const Vec6& xi : twists(13)) {
        const SE3 Z = SE3::exp(0.7 * Vec6::Ones()), T = Z * SE3::exp(xi);
        const PosePriorResidual r(Z, someWhitening());
        Mat6 J;
        EXPECT_LT((r(T, &J) - someWhitening() * xi).norm(), 1e-12);
        const Mat6 n = numericJacobian<6>([&](const SE3& X) { return r(X); }, T);
        EXPECT_LT((J - n).cwiseAbs().maxCoeff(), 1e-7);
    }
}

TEST(ConstantVelocityResidual, VanishesForAnObjectThatKeepsItsTwist) {
    for (const Vec6& v : twists(14)) {
        const SE3 T = SE3::exp(Vec6::Ones());
        const ConstantVelocityResidual r(0.1, someWhitening());
        EXPECT_LT(r(T, v, T * SE3::exp(0.1 * v)).norm(), 1e-12);
    }
}

TEST(ConstantVelocityResidual, JacobiansAgreeWithCentralDifferences) {
    const auto starts = twists(15), velocities = twists(16), errors = twists(17);
    for (double dt : {0.1, 1.0}) {
        for (std::size_t k = 0; k < starts.size(); ++k) {
            const SE3 T_k = SE3::exp(starts[k]);
            const Vec6 v = velocities[k];
            const SE3 T_k1 = T_k * SE3::exp(dt * v) * SE3::exp(errors[k]);
            const ConstantVelocityResidual r(dt, someWhitening());
            Mat6 J_k, J_v, J_k1;
            r(T_k, v, T_k1, &J_k, &J_v, &J_k1);
            const Mat6 n_k = numericJacobian<6>([&](const SE3& T) { return r(T, v, T_k1); }, T_k);
            const Mat6 n_k1 = numericJacobian<6>([&](const SE3& T) { return r(T_k, v, T); }, T_k1);
            const Mat6 n_v =
                numericJacobian<6, 6>([&](const Vec6& x) -> Vec6 { return r(T_k, x, T_k1); }, v);
            EXPECT_LT((J_k - n_k).cwiseAbs().maxCoeff(), 1e-7) << k;
            EXPECT_LT((J_k1 - n_k1).cwiseAbs().maxCoeff(), 1e-7) << k;
            EXPECT_LT((J_v - n_v).cwiseAbs().maxCoeff(), 1e-7) << k;
        }
    }
}

TEST(VectorResiduals, JacobiansAgreeWithCentralDifferences) {
    const auto a = twists(18), b = twists(19);
    const Mat3 W3 = *sqrtInformation<3>(Mat3(Vec3(1, 4, 9).asDiagonal()));
    for (std::size_t k = 0; k < a.size(); ++k) {
        const VectorPriorResidual prior(b[k], someWhitening());
        const PointPriorResidual pointPrior(b[k].head<3>(), W3);
        const TwistDifferenceResidual difference(someWhitening());
        Mat6 J, J1;
        Mat3 J3;
        EXPECT_LT((prior(a[k], &J) - someWhitening() * (a[k] - b[k])).norm(), 1e-13);
        EXPECT_LT((J - numericJacobian<6, 6>([&](const Vec6& x) -> Vec6 { return prior(x); }, a[k]))
                      .norm(),
                  1e-7);
        pointPrior(a[k].head<3>(), &J3);
        EXPECT_LT((J3 - numericJacobian<3, 3>([&](const Vec3& x) -> Vec3 { return pointPrior(x); },
                                              a[k].head<3>()))
                      .norm(),
                  1e-7);
        difference(a[k], b[k], &J, &J1);
        const auto n0 =
            numericJacobian<6, 6>([&](const Vec6& x) -> Vec6 { return difference(x, b[k]); }, a[k]);
        const auto n1 =
            numericJacobian<6, 6>([&](const Vec6& x) -> Vec6 { return difference(a[k], x); }, b[k]);
        EXPECT_LT((J - n0).norm(), 1e-7);
        EXPECT_LT((J1 - n1).norm(), 1e-7);
    }
}

/// Camera and point of a check: points 3 to 30 m ahead.
struct View {
    SE3 T_world_cam;
    Vec3 p_world;
};
std::vector<View> views() {
    std::vector<View> out;
    std::mt19937 rng = generator(20);
    std::uniform_real_distribution<double> u(-1, 1);
    for (const Vec6& xi : twists(21)) {
        const SE3 T = SE3::exp(xi);
        const double depth = 16 + 13 * u(rng);
        out.push_back({T, T * Vec3(0.6 * depth * u(rng), 0.2 * depth * u(rng), depth)});
    }
    return out;
}

/// Checks one point residual against central differences at all views.
template <class R>
void expectPointJacobians(const R& r) {
    constexpr int N = R::kDim;
    for (const View& v : views()) {
        Eigen::Matrix<double, N, 6> J_cam;
        Eigen::Matrix<double, N, 3> J_point;
        ASSERT_TRUE(r(v.T_world_cam, v.p_world, &J_cam, &J_point));
        const auto n_cam = numericJacobian<N>(
            [&](const SE3& T) -> Eigen::Matrix<double, N, 1> { return *r(T, v.p_world); },
            v.T_world_cam);
        const auto n_point = numericJacobian<N, 3>(
            [&](const Vec3& p) -> Eigen::Matrix<double, N, 1> { return *r(v.T_world_cam, p); },
            v.p_world);
        EXPECT_LT((J_cam - n_cam).norm(), 1e-6 * n_cam.norm() + 1e-6);
        EXPECT_LT((J_point - n_point).norm(), 1e-6 * n_point.norm() + 1e-6);
    }
}

TEST(PointResiduals, JacobiansAgreeWithCentralDifferences) {
    const StereoCamera camera = djpete_test::kittiLikeCamera();
    expectPointJacobians(MonoPointResidual(camera, {600, 200}, Vec2(0.5, 2)));
    expectPointJacobians(StereoPointResidual(camera, {600, 200, 570}, Vec3(0.5, 2, 0.7)));
    expectPointJacobians(DepthPointResidual(camera, {600, 200}, 12, 0.1, Vec2(0.5, 2)));
}

TEST(PointResiduals, AreMeasuredMinusPredictedInSigmas) {
    const StereoCamera camera = djpete_test::kittiLikeCamera();
    const Vec3 d(1, -2, 3), w(0.5, 2, 0.25);
    for (const View& v : views()) {
        const Vec3 p_cam = v.T_world_cam.inverse() * v.p_world;
        const Vec3 uvu = camera.projectStereo(p_cam);
        const StereoPointResidual stereo(camera, uvu + d, w);
        EXPECT_LT((*stereo(v.T_world_cam, v.p_world) - w.cwiseProduct(d)).norm(), 1e-9);
        const MonoPointResidual mono(camera, uvu.head<2>() + d.head<2>(), Vec2(w.head<2>()));
        EXPECT_LT((*mono(v.T_world_cam, v.p_world) - w.cwiseProduct(d).head<2>()).norm(), 1e-9);
        const double depth = p_cam.z() + 0.02;
        const DepthPointResidual lidar(camera, uvu.head<2>() + d.head<2>(), depth, 0.05);
        const double inverse = (1 / depth - 1 / p_cam.z()) * depth * depth / 0.05;
        EXPECT_LT((*lidar(v.T_world_cam, v.p_world) - Vec3(d.x(), d.y(), inverse)).norm(), 1e-9);
        EXPECT_NEAR(inverse, -0.02 / 0.05,
                    0.01);  // farther, so less inverse depth: about 0.4 sigma
    }
}

TEST(PointResiduals, AgreeWithThePapersJacobianOfTheInversePose) {
    // NOTES.md: for a LEFT perturbation of T_cw, de/d = -dpi/dP_c [I | -[P_c]x].
    // T_cw <- exp(d) T_cw is T_wc <- T_wc exp(-d): our right Jacobian is its negative.
    const StereoCamera camera = djpete_test::kittiLikeCamera();
    for (const View& v : views()) {
        const Vec3 p = v.T_world_cam.inverse() * v.p_world;
        Mat23 dpi;
        dpi << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()), 0, camera.fy / p.z(),
            -camera.fy * p.y() / (p.z() * p.z());
        Mat36 A;
        A << Mat3::Identity(), -skew(p);
        Mat26 J_cam;
        MonoPointResidual(camera, {1, 2})(v.T_world_cam, v.p_world, &J_cam);
        EXPECT_LT((J_cam - dpi * A).norm(), 1e-9 * J_cam.norm());
        // And the same as a left perturbation of T_wc: J_left = J_right Ad(T)^-1.
        const auto f = [&](const Vec6& d) -> Vec2 {
            return *MonoPointResidual(camera, {1, 2})(SE3::exp(d) * v.T_world_cam, v.p_world);
        };
        const Mat26 left = numericJacobian<2, 6>(f, Vec6(Vec6::Zero()));
        EXPECT_LT((J_cam * v.T_world_cam.inverse().adjoint() - left).norm(), 1e-6 * left.norm());
    }
}

TEST(PointResiduals, HaveNoErrorBehindTheCamera) {
    const StereoCamera camera = djpete_test::kittiLikeCamera();
    Mat36 J_cam = Mat36::Constant(7);
    Mat3 J_point = Mat3::Constant(7);
    for (double z : {-5.0, 0.0, 0.5 * kMinDepth_m}) {
        EXPECT_FALSE(MonoPointResidual(camera, {1, 2})(SE3(), {0.1, 0.2, z}));
        EXPECT_FALSE(DepthPointResidual(camera, {1, 2}, 5, 1)(SE3(), {0.1, 0.2, z}));
        EXPECT_FALSE(
            StereoPointResidual(camera, {1, 2, 3})(SE3(), {0.1, 0.2, z}, &J_cam, &J_point));
    }
    EXPECT_EQ(J_cam, Mat36(Mat36::Constant(7)));
    EXPECT_EQ(J_point, Mat3(Mat3::Constant(7)));
    EXPECT_TRUE(StereoPointResidual(camera, {1, 2, 3})(SE3(), {0, 0, kMinDepth_m}));
}

TEST(PointResiduals, ShowNaN) {
    const auto r =
        MonoPointResidual(djpete_test::kittiLikeCamera(), {1, 2})(SE3(), Vec3(0, 0, std::nan("")));
    ASSERT_TRUE(r);
    EXPECT_FALSE(r->allFinite());
}

}  // namespace
}  // namespace djpete::geometry
