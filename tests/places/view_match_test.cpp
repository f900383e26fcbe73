#include "djpete/places/view_match.h"

#include <gmock/gmock.h>

#include <map>

#include "synthetic_place.h"

namespace djpete::places {
namespace {

using djpete_test::look;
using djpete_test::SightOptions;
using djpete_test::SyntheticPlace;
using geometry::SE3;
using geometry::Vec6;

Vec6 twist(double x, double y, double z, double rx, double ry, double rz) {
    Vec6 v;
    v << x, y, z, rx, ry, rz;
    return v;
}

/// b stands 1.5 m to the right of a, 2 m ahead, turned by 10 degrees.
const SE3 kT_a_b = SE3::exp(twist(1.5, -0.1, 2.0, 0.01, 0.17, -0.02));

struct Views {
    PlaceView a, b;
};
Views views(uint64_t place, const SightOptions& options = {}) {
    const SyntheticPlace points(place);
    return {look(points, SE3(), 1, options), look(points, kT_a_b, 2, options)};
}

double error_m(const ViewMatch& m, const SE3& T_a_b) {
    return (T_a_b.inverse() * m.T_a_b).translation().norm();
}
double error_rad(const ViewMatch& m, const SE3& T_a_b) {
    return (T_a_b.inverse() * m.T_a_b).angle_rad();
}

TEST(MatchViews, findsThePose) {
    for (uint64_t place = 1; place <= 5; ++place) {
        const Views v = views(place);
        const auto match = matchViews(v.a, v.b, {}, 1);
        ASSERT_TRUE(match);
        EXPECT_LT(error_m(*match, kT_a_b), 0.05);
        EXPECT_LT(error_rad(*match, kT_a_b), 0.003);
        EXPECT_GT(match->features.size(), 80U);
    }
}

TEST(MatchViews, pairsAreTheSamePoints) {
    SightOptions noNoise;
    noNoise.sigma_px = 1e-3;
    const Views v = views(1, noNoise);
    const auto match = matchViews(v.a, v.b, {}, 1);
    ASSERT_TRUE(match);
    std::map<uint32_t, const PlaceView::Corner*> a, b;
    for (const auto& c : v.a.corners) a[c.feature] = &c;
    for (const auto& c : v.b.corners) b[c.feature] = &c;
    for (const auto& [fa, fb] : match->features) {
        ASSERT_TRUE(a.count(fa) == 1 && b.count(fb) == 1);
        if (!a[fa]->p_cam) continue;
        const auto predicted = v.b.camera.project(kT_a_b.inverse() * *a[fa]->p_cam);
        EXPECT_LT((predicted - b[fb]->px).norm(), 4);
    }
}

TEST(MatchViews, theOtherWayRoundIsTheInverse) {
    const Views v = views(2);
    const auto ab = matchViews(v.a, v.b, {}, 1), ba = matchViews(v.b, v.a, {}, 1);
    ASSERT_TRUE(ab && ba);
    EXPECT_LT((ab->T_a_b * ba->T_a_b).translation().norm(), 0.02);
    EXPECT_LT((ab->T_a_b * ba->T_a_b).angle_rad(), 0.001);
}

TEST(MatchViews, theSameSeedGivesTheSameBytes) {
    const Views v = views(3);
    const auto one = matchViews(v.a, v.b, {}, 42), two = matchViews(v.a, v.b, {}, 42);
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->T_a_b.matrix(), two->T_a_b.matrix());
    EXPECT_EQ(one->information, two->information);
    EXPECT_EQ(one->features, two->features);
}

TEST(MatchViews, theInformationIsHonest) {
    // With corners that stand where their own sigma says, the error is as the information says:
    // the mean of 6 degrees of freedom, summed over 60 places, to 4 sigmas.
    MatchOptions options;
    options.sigma_px = 0.01;
    options.dependence = 1;
    double sum = 0;
    int places = 0;
    for (uint64_t place = 1; place <= 60; ++place) {
        SightOptions sight;
        sight.strangers = 0.1;
        sight.seed = place;
        const Views v = views(place, sight);
        const auto match = matchViewsNear(v.a, v.b, kT_a_b, options);
        ASSERT_TRUE(match);
        const Vec6 e = (kT_a_b.inverse() * match->T_a_b).log();
        sum += e.dot(match->information * e);
        ++places;
    }
    EXPECT_NEAR(sum / places, 6, 4 * std::sqrt(12.0 / places));
}

TEST(MatchViews, oneCameraWithPointsIsEnough) {
    Views v = views(4);
    for (auto& c : v.b.corners) c.p_cam.reset();
    const auto ab = matchViews(v.a, v.b, {}, 1), ba = matchViews(v.b, v.a, {}, 1);
    ASSERT_TRUE(ab && ba);
    EXPECT_LT(error_m(*ab, kT_a_b), 0.08);
    EXPECT_LT(error_m(*ba, kT_a_b.inverse()), 0.08);
    for (auto& c : v.a.corners) c.p_cam.reset();
    EXPECT_FALSE(matchViews(v.a, v.b, {}, 1));
}

TEST(MatchViews, otherPlacesDoNotMatch) {
    for (uint64_t place = 1; place <= 20; ++place) {
        const auto a = look(SyntheticPlace(place), SE3(), 1);
        const auto b = look(SyntheticPlace(place + 100), SE3(), 2);
        EXPECT_FALSE(matchViews(a, b, {}, place));
        EXPECT_FALSE(matchViewsNear(a, b, SE3(), {}));
    }
}

TEST(MatchViews, aSingleSpotIsNotEnough) {
    // All that is known again lies on one far lorry: the pose is badly known.
    Views v = views(5);
    const auto onSpot = [](const PlaceView::Corner& c) {
        return std::abs(c.px.x() - 600) < 100 && std::abs(c.px.y() - 180) < 60;
    };
    djpete_test::Dice dice(1);
    int kept = 0;
    for (auto& c : v.a.corners) {
        if (onSpot(c)) {
            ++kept;
        } else {
            for (auto& w : c.descriptor) w = dice.word();
        }
    }
    MatchOptions few;
    few.minInliers = 8;
    few.minShare = 0;
    ASSERT_GT(kept, 12);
    EXPECT_FALSE(matchViews(v.a, v.b, few, 1));
    few.minCells = 1;  // it is the spread that was refused
    few.maxSigma_m = few.maxSigma_rad = 1e9;
    EXPECT_TRUE(matchViews(v.a, v.b, few, 1));
}

TEST(MatchViews, nothingInNothing) {
    const Views v = views(6);
    PlaceView bare;
    bare.camera = v.a.camera;
    EXPECT_FALSE(matchViews(v.a, bare, {}, 1));
    EXPECT_FALSE(matchViews(bare, v.a, {}, 1));
    EXPECT_FALSE(matchViewsNear(bare, bare, SE3(), {}));
}

TEST(MatchViewsNear, aGuessFindsMore) {
    SightOptions hard;
    hard.flipped = 0.1;
    hard.strangers = 0.4;
    std::size_t with = 0, without = 0;
    for (uint64_t place = 1; place <= 5; ++place) {
        const Views v = views(place, hard);
        const SE3 guess = kT_a_b * SE3::exp(twist(0.2, 0.1, -0.3, 0.01, 0.01, 0.01));
        MatchOptions options;
        const auto near = matchViewsNear(v.a, v.b, guess, options);
        const auto blind = matchViews(v.a, v.b, options, 1);
        ASSERT_TRUE(near);
        EXPECT_LT(error_m(*near, kT_a_b), 0.1);
        with += near->features.size();
        without += blind ? blind->features.size() : 0;
    }
    EXPECT_GE(with, without);
    EXPECT_GT(with, 5 * 40U);
}

}  // namespace
}  // namespace djpete::places
