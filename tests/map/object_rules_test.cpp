#include "djpete/map/object_rules.h"

#include <gmock/gmock.h>

#include <cmath>

namespace djpete::map {
namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec6;

Mat6 someInformation() {
    Mat6 A;
    for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = std::sin(1.7 * i);
    return A * A.transpose() + Mat6::Identity();
}

ObjectObservation someObservation() {
    Vec6 xi;
    xi << 1, 2, 10, 0.1, 0.7, -0.2;
    ObjectObservation o;
    o.T_cam_obj = SE3::exp(xi);
    o.information = someInformation();
    return o;
}

/// The paper's camera-object error, squared and weighed.
double cost(const ObjectObservation& o, const SE3& T_cam_obj) {
    const Vec6 e = (o.T_cam_obj.inverse() * T_cam_obj).log();
    return e.dot(o.information * e);
}

TEST(ObjectRules, turningRoundKeepsTheCostOfTheSameBox) {
    const auto o = someObservation();
    Vec6 d;
    d << 0.2, -0.1, 0.3, 0.02, -0.05, 0.1;
    const SE3 truth = o.T_cam_obj * SE3::exp(d);
    const SE3 half = SE3::fromYaw(M_PI, {0, 0, 0});
    EXPECT_NEAR(cost(turnedRound(o), truth * half), cost(o, truth), 1e-9);
}

TEST(ObjectRules, turningRoundTwiceIsNothing) {
    const auto o = someObservation();
    const auto twice = turnedRound(turnedRound(o));
    EXPECT_TRUE(twice.T_cam_obj.matrix().isApprox(o.T_cam_obj.matrix(), 1e-12));
    EXPECT_TRUE(twice.information.isApprox(o.information, 1e-12));
}

TEST(ObjectRules, aTurnedObjectGoesTheOtherWayInItsOwnFrame) {
    ObjectState s;
    s.twist << 5, 0.1, 0, 0, 0, 0.3;
    s.covariance = someInformation();
    const auto t = turnedRound(s);
    EXPECT_NEAR(t.twist[0], -5, 1e-12);
    EXPECT_NEAR(t.twist[5], 0.3, 1e-12);
    // The motion in the anchor is the same.
    const SE3 before = s.T_anchor_obj * SE3::exp(s.twist);
    const SE3 after = t.T_anchor_obj * SE3::exp(t.twist);
    EXPECT_TRUE(before.translation().isApprox(after.translation(), 1e-12));
    EXPECT_NEAR(t.covariance.trace(), s.covariance.trace(), 1e-9);
}

TEST(ObjectRules, mergingKeepsWhatWasThereAndFillsTheGaps) {
    ObjectTrack a, b;
    a.id = {3};
    a.size_m = {4, 2, 1};
    b.size_m = {1, 1, 1};
    b.moving = false;
    for (uint64_t f : {0U, 1U, 2U}) a.observations[{f}].frame = {f};
    a.observations[{2}].score = 7;
    b.observations[{2}].frame = {2};
    b.observations[{2}].score = 1;
    b.observations[{5}].frame = {5};
    b.states[{5}].frame = {5};
    b.states[{2}].frame = {2};
    const auto c = merged(a, b);
    EXPECT_EQ(c.id, ObjectId{3});
    EXPECT_EQ(c.observations.size(), 4U);
    EXPECT_FLOAT_EQ(c.observations.at({2}).score, 7);
    EXPECT_EQ(c.states.size(), 2U);
    EXPECT_NEAR(c.size_m.x(), (3 * 4 + 2 * 1) / 5.0, 1e-12);
}

}  // namespace
}  // namespace djpete::map
