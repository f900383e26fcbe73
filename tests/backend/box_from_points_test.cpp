#include "djpete/backend/box_from_points.h"

#include <gtest/gtest.h>

#include "scanned_box.h"

namespace djpete::backend {
namespace {

using geometry::SE3;
using geometry::Vec3;

const Vec3 kSize(4.3, 1.8, 1.5);
constexpr double kNoise_m = 0.01;
/// A side is taken to lie at the outermost of its points, about a thousand here: 3 sigma and a bit.
constexpr double kOutermost = 3.5 * kNoise_m;
/// Where the box really is, in the frame of a poor estimate of it.
const SE3 kTrue = SE3::fromYaw(0.05, {0.2, -0.15, 0.1});

BoxPrior poorPrior() {
    BoxPrior prior;
    prior.size_m = kSize;
    prior.sigma_m = Vec3::Constant(0.2);
    prior.yawSigma_rad = 0.06;
    return prior;
}

BoxPoints pointsSeenFrom(const std::vector<Vec3>& origins, const Vec3& size_m = kSize) {
    djpete_test::Random random(3);
    BoxPoints out;
    for (const Vec3& origin : origins) {
        const auto view = djpete_test::scannedBox(kTrue, size_m, origin, random, 0.12, kNoise_m);
        out.body.insert(out.body.end(), view.body.begin(), view.body.end());
        out.ground.insert(out.ground.end(), view.ground.begin(), view.ground.end());
        out.origins.push_back(view.origin);
    }
    return out;
}

const std::vector<Vec3> kBehindRight{{-12, -6, 1}}, kBehind{{-15, 0, 1}},
    kAllAround{{-12, -6, 1}, {12, 6, 1}};

TEST(BoxFromPoints, aCornerPlacesIt) {
    const auto fit = fitBox(pointsSeenFrom(kBehindRight), poorPrior());
    ASSERT_TRUE(fit);
    EXPECT_TRUE(fit->rear && fit->right && fit->bottom);
    EXPECT_FALSE(fit->front || fit->left);
    const SE3 apart = fit->T_obj_fitted.inverse() * kTrue;
    EXPECT_LT(apart.translation().norm(), 0.04);
    EXPECT_LT(std::abs(apart.yaw_rad()), 0.006);
    EXPECT_LT((fit->size_m - kSize).cwiseAbs().maxCoeff(), kOutermost);
    EXPECT_LT(fit->sigma_m.maxCoeff(), 0.06);
    EXPECT_LT(fit->yawSigma_rad, 0.01);
}

TEST(BoxFromPoints, anEndAloneSaysWhereItsMiddleIs) {
    const auto fit = fitBox(pointsSeenFrom(kBehind), poorPrior());
    ASSERT_TRUE(fit);
    EXPECT_TRUE(fit->rear);
    EXPECT_FALSE(fit->right || fit->left);
    // The prior's heading, which is 0.05 rad wrong, moves a centre 2 m before the rear by 0.1 m.
    const SE3 apart = fit->T_obj_fitted.inverse() * kTrue;
    EXPECT_LT(std::abs(apart.translation().x()), 0.06);
    EXPECT_LT(std::abs(apart.translation().y()), 0.15);
    EXPECT_GT(fit->yawSigma_rad, 0.03);
}

TEST(BoxFromPoints, aBoxSeenFromAllSidesTellsItsSize) {
    const Vec3 longer(4.6, 1.9, 1.6);
    BoxPrior prior = poorPrior();
    prior.sizeSigma_m = Vec3::Constant(0.2);
    const auto fit = fitBox(pointsSeenFrom(kAllAround, longer), prior);
    ASSERT_TRUE(fit);
    EXPECT_TRUE(fit->rear && fit->front && fit->right && fit->left);
    EXPECT_LT((fit->size_m - longer).cwiseAbs().maxCoeff(), 2 * kOutermost);
    EXPECT_LT((fit->T_obj_fitted.inverse() * kTrue).translation().norm(), 0.03);
}

TEST(BoxFromPoints, aWallBesideItIsNotPartOfIt) {
    auto points = pointsSeenFrom(kBehindRight);
    const auto alone = fitBox(points, poorPrior());
    for (double x = -3; x < 3; x += 0.1) {
        for (double z = -0.5; z < 2; z += 0.1) {
            points.body.push_back((kTrue * Vec3(x, 0.5 * kSize.y() + 0.28, z)).cast<float>());
        }
    }
    const auto fit = fitBox(points, poorPrior());
    ASSERT_TRUE(alone && fit);
    EXPECT_FALSE(fit->left);
    EXPECT_LT((fit->T_obj_fitted.inverse() * kTrue).translation().norm(), 0.08);
    EXPECT_LT((fit->size_m - kSize).cwiseAbs().maxCoeff(), 0.08);
}

TEST(BoxFromPoints, aHandfulOfPointsSaysNothing) {
    auto points = pointsSeenFrom(kBehindRight);
    points.body.resize(10);
    EXPECT_FALSE(fitBox(points, poorPrior()));
    EXPECT_FALSE(fitBox({}, poorPrior()));
}

}  // namespace
}  // namespace djpete::backend
