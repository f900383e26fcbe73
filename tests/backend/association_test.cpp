#include "djpete/backend/association.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::SE3;
using geometry::Vec3;

map::ObjectObservation seenAt(const SE3& T_world_obj, uint64_t frame) {
    map::ObjectObservation o;
    o.frame = {frame};
    o.T_cam_obj = T_world_obj;  // these tests hold the camera at the world's origin
    o.information = obs::diagonalInformation(Vec3::Constant(0.3), Vec3::Constant(0.09));
    o.size_m = {4.2, 1.7, 1.5};
    return o;
}

ObjectAssociator::Frame frameAt(uint64_t frame) {
    ObjectAssociator::Frame f;
    f.frame = {frame};
    f.time_s = 0.1 * static_cast<double>(frame);
    return f;
}

TEST(Associator, twoCarsThatPassEachOtherStayTwo) {
    ObjectAssociator associator{AssociationOptions{}};
    djpete_test::Random random(1);
    std::vector<uint64_t> left, right;
    for (uint64_t i = 0; i < 60; ++i) {
        const double t = 0.1 * static_cast<double>(i);
        const Vec3 a(10 * t, 1.6, 0), b(60 - 10 * t, -1.6, 0);
        associator.associate(frameAt(i), {seenAt(SE3::fromYaw(0, a + random.normal3(0.2)), i),
                                          seenAt(SE3::fromYaw(M_PI, b + random.normal3(0.2)), i)});
    }
    ASSERT_EQ(associator.things().size(), 2U);
    for (const auto& [key, thing] : associator.things()) {
        EXPECT_EQ(thing.hits, 60U);
        EXPECT_FALSE(thing.filter.likelyStatic());
        EXPECT_NEAR(std::abs(thing.filter.velocity_mps().x()), 10, 1);
    }
}

TEST(Associator, aStandingCarIsKnownAgainAfterLongOcclusion) {
    ObjectAssociator associator{AssociationOptions{}};
    djpete_test::Random random(2);
    uint64_t key = 0;
    for (uint64_t i = 0; i < 200; ++i) {
        std::vector<map::ObjectObservation> seen;
        if (i < 20 || i >= 180) {
            seen.push_back(seenAt(SE3::fromYaw(0.5, Vec3(20, 5, 0) + random.normal3(0.3)), i));
        }
        const auto hits = associator.associate(frameAt(i), seen);
        if (i == 3) {
            key = hits.at(0);
            associator.thing(key).object = map::ObjectId{0};
        }
    }
    ASSERT_EQ(associator.things().size(), 1U);
    EXPECT_EQ(associator.things().begin()->first, key);
    EXPECT_EQ(associator.things().at(key).hits, 40U);
}

TEST(Associator, aMovingCarIsKnownAgainAfterThirtyFrames) {
    ObjectAssociator associator{AssociationOptions{}};
    djpete_test::Random random(3);
    for (uint64_t i = 0; i < 80; ++i) {
        const Vec3 p(0.8 * static_cast<double>(i), 3, 0);
        std::vector<map::ObjectObservation> seen;
        if (i < 30 || i >= 60) seen.push_back(seenAt(SE3::fromYaw(0, p + random.normal3(0.2)), i));
        const auto hits = associator.associate(frameAt(i), seen);
        if (i == 3) associator.thing(hits.at(0)).object = map::ObjectId{0};
    }
    ASSERT_EQ(associator.things().size(), 1U);
    EXPECT_EQ(associator.things().begin()->second.hits, 50U);
}

TEST(Associator, flippedHeadingsAreTurnedToTheTracks) {
    ObjectAssociator associator{AssociationOptions{}};
    for (uint64_t i = 0; i < 10; ++i) {
        const double yaw = 0.4 + (i % 3 == 1 ? M_PI : 0);
        associator.associate(frameAt(i), {seenAt(SE3::fromYaw(yaw, {20, 5, 0}), i)});
    }
    ASSERT_EQ(associator.things().size(), 1U);
    const auto& thing = associator.things().begin()->second;
    ASSERT_EQ(thing.waiting.size(), 10U);
    for (const auto& o : thing.waiting) EXPECT_NEAR(o.T_cam_obj.yaw_rad(), 0.4, 1e-9);
}

TEST(Associator, candidatesSeenOnceAreDropped) {
    ObjectAssociator associator{AssociationOptions{}};
    associator.associate(frameAt(0), {seenAt(SE3::fromYaw(0, {20, 5, 0}), 0)});
    EXPECT_FALSE(associator.confirmed(associator.things().begin()->second));
    for (uint64_t i = 1; i < 6; ++i) associator.associate(frameAt(i), {});
    EXPECT_TRUE(associator.things().empty());
}

TEST(Associator, doubleDetectionsMakeOneThing) {
    ObjectAssociator associator{AssociationOptions{}};
    for (uint64_t i = 0; i < 5; ++i) {
        associator.associate(frameAt(i), {seenAt(SE3::fromYaw(0, {20, 5, 0}), i),
                                          seenAt(SE3::fromYaw(0.1, {20.4, 5.2, 0}), i)});
    }
    EXPECT_EQ(associator.things().size(), 1U);
    EXPECT_EQ(associator.doubles(), 5U);
}

TEST(Associator, neighboursInARowOfParkedCarsAreNotMixedUp) {
    ObjectAssociator associator{AssociationOptions{}};
    djpete_test::Random random(4);
    for (uint64_t i = 0; i < 40; ++i) {
        std::vector<map::ObjectObservation> seen;
        for (int car = 0; car < 8; ++car) {  // side by side, 2.4 m apart
            if (random.uniform() < 0.2) continue;
            const Vec3 p(20, 2.4 * car, 0);
            seen.push_back(seenAt(SE3::fromYaw(random.normal(0.09), p + random.normal3(0.3)), i));
        }
        const auto hits = associator.associate(frameAt(i), seen);
        for (const auto key : hits) {
            auto& thing = associator.thing(key);
            if (!thing.object && associator.confirmed(thing)) thing.object = map::ObjectId{key};
        }
    }
    unsigned objects = 0;
    for (const auto& [key, thing] : associator.things()) objects += thing.object ? 1U : 0U;
    EXPECT_EQ(objects, 8U);
}

TEST(Associator, thingsFollowTheirAnchor) {
    ObjectAssociator associator{AssociationOptions{}};
    associator.associate(frameAt(0), {seenAt(SE3::fromYaw(0, {20, 5, 0}), 0)});
    const SE3 T = SE3::fromYaw(M_PI / 2, {1, 2, 3});
    associator.follow([&](map::KeyframeId) { return T; });
    const auto& filter = associator.things().begin()->second.filter;
    EXPECT_TRUE(filter.p_world().isApprox(T * Vec3(20, 5, 0), 1e-12));
    EXPECT_NEAR(filter.yaw_rad(), M_PI / 2, 1e-12);
}

}  // namespace
}  // namespace djpete::backend
