/// When a thing is one, and which end of it is the front.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "djpete/backend/association.h"
#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::SE3;
using geometry::Vec3;

map::ObjectObservation seenAt(const SE3& T_world_obj, uint64_t frame, float score = 1) {
    map::ObjectObservation o;
    o.frame = {frame};
    o.T_cam_obj = T_world_obj;  // these tests hold the camera at the world's origin
    o.information = obs::diagonalInformation(Vec3::Constant(0.3), Vec3::Constant(0.09));
    o.size_m = {4.2, 1.7, 1.5};
    o.score = score;
    return o;
}

ObjectAssociator::Frame frameAt(uint64_t frame) {
    ObjectAssociator::Frame f;
    f.frame = {frame};
    f.time_s = 0.1 * static_cast<double>(frame);
    return f;
}

map::ObjectObservation rubbish(djpete_test::Random& random, uint64_t frame) {
    const Vec3 p(random.uniform(3, 80), random.uniform(-40, 40), random.uniform(-2, 0));
    return seenAt(SE3::fromYaw(random.uniform(-3, 3), p), frame);
}

/// Confirmed ones become objects, as the map's owner does it.
unsigned confirm(ObjectAssociator& associator, const std::vector<uint64_t>& hits) {
    unsigned n = 0;
    for (const auto key : hits) {
        auto& thing = associator.thing(key);
        if (thing.object || !associator.confirmed(thing)) continue;
        thing.object = map::ObjectId{key};
        ++n;
    }
    return n;
}

/// Frames until a car that stands at (20, 5) is an object, with `clutter` boxes of rubbish beside
/// it in each frame and before it comes.
uint64_t framesUntilSure(unsigned clutter, AssociationOptions options = {}, float score = 1) {
    ObjectAssociator associator(options);
    djpete_test::Random random(7);
    const SE3 T_world_obj = SE3::fromYaw(0.3, {20, 5, -1});
    const uint64_t before = 60;
    for (uint64_t i = 0; i < before + 40; ++i) {
        std::vector<map::ObjectObservation> seen;
        if (i >= before) {
            seen.push_back(seenAt(T_world_obj * SE3::fromYaw(0, random.normal3(0.2)), i, score));
        }
        for (unsigned k = 0; k < clutter; ++k) seen.push_back(rubbish(random, i));
        confirm(associator, associator.associate(frameAt(i), seen));
        for (const auto& [key, thing] : associator.things()) {
            if (thing.object && i >= before &&
                (thing.filter.p_world() - T_world_obj.translation()).norm() < 1) {
                return i - before + 1;
            }
        }
    }
    return 1000;
}

TEST(Existence, aCarWithoutClutterIsSureAtOnce) {
    EXPECT_EQ(framesUntilSure(0), AssociationOptions().minDetections);
}

TEST(Existence, clutterRaisesTheBar) {
    EXPECT_GT(framesUntilSure(150), framesUntilSure(0));
    EXPECT_LT(framesUntilSure(150), 30U);  // and a real car still gets over it
}

TEST(Existence, randomBoxesRarelyBecomeObjects) {
    for (const unsigned perFrame : {20U, 200U}) {
        ObjectAssociator associator{AssociationOptions{}};
        djpete_test::Random random(8);
        unsigned objects = 0;
        std::size_t things = 0;
        const uint64_t frames = 50;
        for (uint64_t i = 0; i < frames; ++i) {
            std::vector<map::ObjectObservation> seen;
            for (unsigned k = 0; k < perFrame; ++k) seen.push_back(rubbish(random, i));
            objects += confirm(associator, associator.associate(frameAt(i), seen));
            things = std::max(things, associator.things().size());
        }
        std::cout << perFrame << " random boxes in each of " << frames << " frames: " << objects
                  << " objects, at most " << things << " things at once\n";
        RecordProperty("objects_of_" + std::to_string(perFrame), int(objects));
        // One in a thousand boxes at most.
        EXPECT_LE(objects, perFrame * frames / 1000);
        // Candidates live for maxMisses + 1 frames, unless they are hit.
        EXPECT_LE(things, perFrame * 2 * (AssociationOptions().maxMisses + 2));
    }
}

TEST(Existence, missesLowerItAndHitsRaiseIt) {
    ObjectAssociator associator{AssociationOptions{}};
    const SE3 T = SE3::fromYaw(0, {0, 0, 20});  // ahead of a camera at the origin
    std::vector<double> odds;
    for (const bool hit : {true, true, true, false, false, true}) {
        const uint64_t i = odds.size();
        std::vector<map::ObjectObservation> seen;
        if (hit) seen.push_back(seenAt(T, i));
        associator.associate(frameAt(i), seen);
        ASSERT_EQ(associator.things().size(), 1U);
        odds.push_back(associator.things().begin()->second.existence);
    }
    EXPECT_GT(odds[1], odds[0]);
    EXPECT_GT(odds[2], odds[1]);
    const double rate = AssociationOptions().detectionRate;
    EXPECT_NEAR(odds[3] - odds[2], std::log(1 - rate), 1e-12);
    EXPECT_NEAR(odds[4] - odds[3], std::log(1 - rate), 1e-12);
    EXPECT_GT(odds[5], odds[4]);
}

TEST(Existence, whatIsOutOfViewIsNotMissed) {
    ObjectAssociator associator{AssociationOptions{}};
    const SE3 T = SE3::fromYaw(0, {0, 0, 20});
    for (uint64_t i = 0; i < 3; ++i) associator.associate(frameAt(i), {seenAt(T, i)});
    const double before = associator.things().begin()->second.existence;
    auto past = frameAt(3);
    past.T_world_cam = SE3::fromYaw(0, {0, 0, 25});
    associator.associate(past, {});
    EXPECT_EQ(associator.things().begin()->second.existence, before);
    auto far = frameAt(4);
    far.T_world_cam = SE3::fromYaw(0, {0, 0, -20});
    associator.associate(far, {});
    EXPECT_EQ(associator.things().begin()->second.existence, before);
}

TEST(Existence, anObjectOfFewDetectionsThatIsInViewAndMissedIsAGhost) {
    ObjectAssociator associator{AssociationOptions{}};
    const SE3 T = SE3::fromYaw(0, {0, 0, 20});
    for (uint64_t i = 0; i < 3; ++i) associator.associate(frameAt(i), {seenAt(T, i)});
    const uint64_t key = associator.things().begin()->first;
    associator.thing(key).object = map::ObjectId{0};
    EXPECT_TRUE(associator.ghosts().empty());
    for (uint64_t i = 3; i < 13; ++i) associator.associate(frameAt(i), {});
    EXPECT_EQ(associator.ghosts(), std::vector<uint64_t>{key});
}

TEST(Existence, aScoreSaysHowSurely) {
    AssociationOptions scored;
    scored.scoreSlope = 1;
    scored.evenScore = 5;
    const auto good = framesUntilSure(150, scored, 8), even = framesUntilSure(150, scored, 5),
               bad = framesUntilSure(150, scored, 2);
    EXPECT_LE(good, even);
    EXPECT_LT(good, bad);

    // The first detection says it alone; beyond maxScoreOdds a score says no more.
    const auto first = [&](float score, const AssociationOptions& options) {
        ObjectAssociator associator(options);
        associator.associate(frameAt(0), {seenAt(SE3::fromYaw(0, {20, 5, 0}), 0, score)});
        return associator.things().begin()->second.existence;
    };
    EXPECT_NEAR(first(6, scored) - first(5, scored), 1, 1e-6);
    EXPECT_NEAR(first(1e6F, scored) - first(5, scored), scored.maxScoreOdds, 1e-12);
    EXPECT_NEAR(first(-1e6F, scored) - first(5, scored), -scored.maxScoreOdds, 1e-12);
    EXPECT_EQ(first(6, AssociationOptions{}), first(-6, AssociationOptions{}));
}

/// A car goes through 30 frames; its detections point along `yaw`. True if it was said to be the
/// wrong way round at the end; then the owner turns it.
struct Heading {
    bool wrong = false;
    double yaw_rad = 0;
    unsigned turned = 0;
};
Heading headingOf(double speed_mps, const std::function<double(uint64_t)>& yaw_rad) {
    ObjectAssociator associator{AssociationOptions{}};
    Heading out;
    for (uint64_t i = 0; i < 30; ++i) {
        const Vec3 p(20 + 0.1 * speed_mps * static_cast<double>(i), 5, 0);
        const auto hits =
            associator.associate(frameAt(i), {seenAt(SE3::fromYaw(yaw_rad(i), p), i)});
        EXPECT_EQ(hits.size(), 1U);
        auto& thing = associator.thing(hits.at(0));
        EXPECT_TRUE(i > 0 || thing.headingOdds > 0);
        if (thing.headingWrong) {
            associator.turnRound(thing.key);
            ++out.turned;
            EXPECT_FALSE(thing.headingWrong);
            EXPECT_GT(thing.headingOdds, 0);
        }
    }
    EXPECT_EQ(associator.things().size(), 1U);
    const auto& thing = associator.things().begin()->second;
    EXPECT_EQ(thing.hits, 30U);
    out.yaw_rad = thing.filter.yaw_rad();
    for (const auto& o : thing.waiting) {
        EXPECT_NEAR(geometry::wrapAngle(o.T_cam_obj.yaw_rad() - out.yaw_rad), 0, 0.1);
    }
    return out;
}

TEST(HeadingVotes, aFirstDetectionTurnedRoundIsOutvoted) {
    const auto h = headingOf(0, [](uint64_t i) { return i == 0 ? M_PI : 0.0; });
    EXPECT_EQ(h.turned, 1U);
    EXPECT_NEAR(geometry::wrapAngle(h.yaw_rad), 0, 0.05);
}

TEST(HeadingVotes, aFewTurnedRoundDoNotTurnIt) {
    const auto h = headingOf(0, [](uint64_t i) { return i % 4 == 3 ? M_PI : 0.0; });
    EXPECT_EQ(h.turned, 0U);
    EXPECT_NEAR(geometry::wrapAngle(h.yaw_rad), 0, 0.05);
}

TEST(HeadingVotes, motionSaysIfDetectionsDoNot) {
    // As often one way as the other, in turns; the car goes along +x.
    const auto forward = [](uint64_t i) { return i % 2 == 1 ? M_PI : 0.0; };
    const auto backward = [](uint64_t i) { return i % 2 == 0 ? M_PI : 0.0; };
    EXPECT_NEAR(geometry::wrapAngle(headingOf(8, forward).yaw_rad), 0, 0.05);
    EXPECT_NEAR(geometry::wrapAngle(headingOf(8, backward).yaw_rad), 0, 0.05);
    EXPECT_EQ(headingOf(8, backward).turned, 1U);
}

TEST(HeadingVotes, aCarThatIsTurnedRoundKeepsItsSpeedInTheWorld) {
    ObjectAssociator associator{AssociationOptions{}};
    for (uint64_t i = 0; i < 20; ++i) {
        const Vec3 p(20 + 0.8 * static_cast<double>(i), 5, 0);
        associator.associate(frameAt(i), {seenAt(SE3::fromYaw(0.1, p), i)});
    }
    const uint64_t key = associator.things().begin()->first;
    const Vec3 before = associator.thing(key).filter.velocity_mps();
    associator.turnRound(key);
    const auto& filter = associator.thing(key).filter;
    EXPECT_TRUE(filter.velocity_mps().isApprox(before, 1e-12));
    EXPECT_NEAR(geometry::wrapAngle(filter.yaw_rad() - 0.1 - M_PI), 0, 0.05);
}

}  // namespace
}  // namespace djpete::backend
