#include "djpete/backend/association.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "djpete/backend/assignment.h"
#include "djpete/backend/overlap.h"
#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::SE3;
using geometry::Vec3;

double costOf(const Eigen::MatrixXd& cost, const std::vector<std::optional<std::size_t>>& columns,
              double unassigned) {
    double sum = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        sum += columns[i]
                   ? cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*columns[i]))
                   : unassigned;
    }
    return sum;
}

/// Tries all ways.
double leastCost(const Eigen::MatrixXd& cost, double unassigned, Eigen::Index row,
                 std::vector<bool>& used) {
    if (row == cost.rows()) return 0;
    double least = unassigned + leastCost(cost, unassigned, row + 1, used);
    for (Eigen::Index j = 0; j < cost.cols(); ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (used[k] || !(cost(row, j) <= unassigned)) continue;
        used[k] = true;
        least = std::min(least, cost(row, j) + leastCost(cost, unassigned, row + 1, used));
        used[k] = false;
    }
    return least;
}

TEST(Assignment, isAsGoodAsTryingAllWays) {
    djpete_test::Random random(3);
    for (int round = 0; round < 200; ++round) {
        const int n = static_cast<int>(random.uniform(0, 6));
        const int m = static_cast<int>(random.uniform(0, 6));
        Eigen::MatrixXd cost(n, m);
        for (int i = 0; i < n * m; ++i) {
            const double c = random.uniform(-5, 15);
            cost.data()[i] = c > 13 ? std::numeric_limits<double>::infinity() : c;
        }
        const auto columns = assign(cost, 10);
        ASSERT_EQ(columns.size(), static_cast<std::size_t>(n));
        std::vector<bool> used(static_cast<std::size_t>(m), false);
        for (const auto& c : columns) {
            if (!c) continue;
            EXPECT_FALSE(used[*c]);
            used[*c] = true;
        }
        std::fill(used.begin(), used.end(), false);
        EXPECT_NEAR(costOf(cost, columns, 10), leastCost(cost, 10, 0, used), 1e-9);
    }
}

TEST(Assignment, whatIsForbiddenStaysAlone) {
    Eigen::MatrixXd cost(2, 1);
    cost << std::nan(""), 11;
    const auto columns = assign(cost, 10);
    EXPECT_FALSE(columns[0]);
    EXPECT_FALSE(columns[1]);
    EXPECT_TRUE(assign(Eigen::MatrixXd(0, 3), 1).empty());
}

TEST(Overlap, ofKnownBoxes) {
    const UprightBox a{{0, 0, 0}, 0, {4, 2, 1}};
    EXPECT_NEAR(birdsEyeOverlap(a, a), 1, 1e-12);
    EXPECT_NEAR(birdsEyeOverlap(a, {{2, 0, 0}, 0, {4, 2, 1}}), 1.0 / 3, 1e-12);
    EXPECT_NEAR(birdsEyeOverlap(a, {{0, 0, 0}, M_PI / 2, {4, 2, 1}}), 4.0 / 12, 1e-12);
    EXPECT_NEAR(birdsEyeOverlap(a, {{0, 0, 0}, M_PI, {4, 2, 1}}), 1, 1e-12);
    EXPECT_EQ(birdsEyeOverlap(a, {{4.1, 0, 0}, 0, {4, 2, 1}}), 0);
    EXPECT_NEAR(volumeOverlap(a, {{0, 0, 0.5}, 0, {4, 2, 1}}), 1.0 / 3, 1e-12);
    // A square turned by 45 degrees in one of the same width: a regular octagon.
    const UprightBox s{{100, 50, 0}, 0.3, {2, 2, 1}}, t{{100, 50, 0}, 0.3 + M_PI / 4, {2, 2, 1}};
    const double octagon = 8 * (std::sqrt(2.0) - 1);
    EXPECT_NEAR(birdsEyeOverlap(s, t), octagon / (8 - octagon), 1e-9);
    EXPECT_NEAR(imageOverlap({0, 0, 10, 10}, {5, 0, 15, 10}), 1.0 / 3, 1e-6);
    EXPECT_EQ(imageOverlap({0, 0, 10, 10}, {20, 0, 30, 10}), 0);
}

TEST(Overlap, ofRandomBoxesIsTheShareOfRandomPoints) {
    djpete_test::Random random(5);
    for (int round = 0; round < 10; ++round) {
        const UprightBox a{{0, 0, 0}, random.uniform(-3, 3), {4, 2, 1}};
        const UprightBox b{{random.uniform(-2, 2), random.uniform(-1, 1), 0},
                           random.uniform(-3, 3),
                           {random.uniform(2, 5), random.uniform(1, 3), 1}};
        const auto inside = [](const UprightBox& box, const Vec3& p) {
            const Vec3 q = SE3::fromYaw(box.yaw_rad, box.centre).inverse() * p;
            return std::abs(q.x()) <= box.size_m.x() / 2 && std::abs(q.y()) <= box.size_m.y() / 2;
        };
        double both = 0, either = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p(random.uniform(-6, 6), random.uniform(-6, 6), 0);
            const bool inA = inside(a, p), inB = inside(b, p);
            both += inA && inB ? 1 : 0;
            either += inA || inB ? 1 : 0;
        }
        EXPECT_NEAR(birdsEyeOverlap(a, b), both / either, 0.03);
    }
}

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
