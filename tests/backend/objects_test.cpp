#include "djpete/backend/objects.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

constexpr double kSigma_m = 0.3, kSigma_rad = 0.087;

/// An object seen from a camera that passes by, with noise.
ObjectProblem::Object seen(const std::function<SE3(double)>& T_world_obj, unsigned n,
                           uint64_t seed) {
    djpete_test::Random random(seed);
    ObjectProblem::Object object;
    for (unsigned i = 0; i < n; ++i) {
        ObjectProblem::Edge e;
        e.frame = {i};
        e.time_s = 0.1 * i;
        e.anchor = {i / 3};
        e.T_world_anchor = SE3::fromYaw(0.02 * (i / 3), Vec3(0.8 * (i / 3) * 3, 0, 0));
        e.T_world_cam = SE3::fromYaw(0.02 * i, Vec3(0.8 * i, 0, 0));
        Vec6 noise;
        noise << random.normal3(kSigma_m), random.normal3(kSigma_rad);
        e.T_cam_obj = e.T_world_cam.inverse() * T_world_obj(e.time_s) * SE3::exp(noise);
        e.information =
            obs::diagonalInformation(Vec3::Constant(kSigma_m), Vec3::Constant(kSigma_rad));
        e.size_m = Vec3(4.2, 1.7, 1.5) + random.normal3(0.1);
        object.edges.push_back(e);
    }
    return object;
}

SE3 T_world_obj(const ObjectProblem::Object& in, const map::ObjectState& state) {
    for (const auto& e : in.edges) {
        if (e.anchor == state.anchor) return e.T_world_anchor * state.T_anchor_obj;
    }
    ADD_FAILURE() << "a state with an anchor that no edge has";
    return SE3();
}

ObjectUpdate::Object solveOne(ObjectProblem::Object object) {
    ObjectProblem problem;
    problem.all = true;
    problem.objects.push_back(std::move(object));
    return solve(problem, ObjectOptions{}).objects.at(0);
}

const SE3 kParked = SE3::fromYaw(0.7, {30, 6, -1});

TEST(ObjectSolve, aStandingObjectIsTheMeanOfItsViews) {
    const auto in = seen([](double) { return kParked; }, 40, 1);
    const auto out = solveOne(in);
    ASSERT_TRUE(out.solved);
    EXPECT_FALSE(out.moving);
    ASSERT_EQ(out.states.size(), in.edges.size());
    for (const auto& s : out.states) {
        const Vec6 e = (kParked.inverse() * T_world_obj(in, s)).log();
        EXPECT_LT(e.head<3>().norm(), 4 * kSigma_m / std::sqrt(40.0));
        EXPECT_LT(e.tail<3>().norm(), 4 * kSigma_rad / std::sqrt(40.0));
        EXPECT_EQ(s.anchor, out.states.front().anchor);
    }
    EXPECT_TRUE(out.size_m.isApprox(Vec3(4.2, 1.7, 1.5), 0.05));
}

TEST(ObjectSolve, theCovarianceIsThatOfTheErrors) {
    double sum = 0;
    const int runs = 60;
    for (int i = 0; i < runs; ++i) {
        const auto in = seen([](double) { return kParked; }, 20, static_cast<uint64_t>(100 + i));
        const auto out = solveOne(in);
        const Vec6 e = (T_world_obj(in, out.states[0]).inverse() * kParked).log();
        sum += e.dot(out.states[0].covariance.inverse() * e);
    }
    // The mean of 60 chi^2 with 6 degrees of freedom is 6 +- 0.45; robust weights widen the
    // covariance a little.
    EXPECT_GT(sum / runs, 3.5);
    EXPECT_LT(sum / runs, 7.5);
}

TEST(ObjectSolve, aThirdOfRubbishDoesNotMoveIt) {
    auto in = seen([](double) { return kParked; }, 30, 2);
    djpete_test::Random random(9);
    for (std::size_t i = 0; i < in.edges.size(); i += 3) {
        Vec6 noise;
        noise << random.normal3(3), random.normal3(1);
        in.edges[i].T_cam_obj = in.edges[i].T_cam_obj * SE3::exp(noise);
    }
    const auto out = solveOne(in);
    ASSERT_TRUE(out.solved);
    EXPECT_FALSE(out.moving);
    EXPECT_LT((T_world_obj(in, out.states[0]).translation() - kParked.translation()).norm(), 0.25);
}

TEST(ObjectSolve, aMovingObjectHasPoseAndTwistAtEveryView) {
    Vec6 twist = Vec6::Zero();
    twist[0] = 9;
    twist[5] = 0.3;
    const auto truth = [&](double t) { return kParked * SE3::exp(t * twist); };
    const auto in = seen(truth, 40, 3);
    const auto out = solveOne(in);
    ASSERT_TRUE(out.solved);
    EXPECT_TRUE(out.moving);
    EXPECT_FALSE(out.turnRound);
    ASSERT_EQ(out.states.size(), 40U);
    double position = 0, speed = 0;
    for (const auto& s : out.states) {
        const SE3 T = truth(0.1 * static_cast<double>(s.frame.value));
        position += (T_world_obj(in, s).translation() - T.translation()).norm() / 40;
        speed += std::abs(s.twist[0] - 9) / 40;
        EXPECT_LT(s.covariance(0, 0), kSigma_m * kSigma_m);
    }
    EXPECT_LT(position, 0.3);  // a single view has 0.48 on average
    EXPECT_LT(speed, 0.3);
}

TEST(ObjectSolve, whatGoesBackwardsIsTurnedRound) {
    Vec6 twist = Vec6::Zero();
    twist[0] = -8;
    const auto out = solveOne(seen([&](double t) { return kParked * SE3::exp(t * twist); }, 20, 4));
    EXPECT_TRUE(out.moving);
    EXPECT_TRUE(out.turnRound);
}

TEST(ObjectSolve, motionIsJudgedByEvidenceAndStaysForAWhile) {
    const auto at = [](double speed) {
        return [speed](double t) { return kParked * SE3::fromYaw(0, Vec3(speed * t, 0, 0)); };
    };
    EXPECT_FALSE(solveOne(seen(at(0), 30, 5)).moving);
    EXPECT_TRUE(solveOne(seen(at(3), 30, 5)).moving);
    // Creeping: not enough to become moving, enough to stay so.
    auto creeping = seen(at(0.6), 30, 5);
    EXPECT_FALSE(solveOne(creeping).moving);
    creeping.moving = true;
    EXPECT_TRUE(solveOne(creeping).moving);
    auto stopped = seen(at(0), 30, 5);
    stopped.moving = true;
    EXPECT_FALSE(solveOne(stopped).moving);
}

TEST(ObjectSolve, aFastCarSeenThreeTimesMoves) {
    const auto fast = [](double t) { return kParked * SE3::fromYaw(0, Vec3(20 * t, 0, 0)); };
    EXPECT_TRUE(solveOne(seen(fast, 3, 6)).moving);
}

TEST(ObjectSolve, objectsDoNotTouchEachOther) {
    ObjectProblem both;
    both.all = true;
    both.objects.push_back(seen([](double) { return kParked; }, 20, 7));
    both.objects.push_back(seen([](double t) { return SE3::fromYaw(0, {5 * t, 3, 0}); }, 20, 8));
    const auto together = solve(both, ObjectOptions{});
    for (std::size_t i = 0; i < 2; ++i) {
        const auto alone = solveOne(both.objects[i]);
        ASSERT_EQ(alone.states.size(), together.objects[i].states.size());
        for (std::size_t k = 0; k < alone.states.size(); ++k) {
            EXPECT_EQ(alone.states[k].T_anchor_obj.matrix(),
                      together.objects[i].states[k].T_anchor_obj.matrix());
        }
    }
}

TEST(ObjectSolve, oneOrTwoViewsAndNoneAtAll) {
    EXPECT_TRUE(solveOne(seen([](double) { return kParked; }, 1, 1)).solved);
    EXPECT_TRUE(solveOne(seen([](double) { return kParked; }, 2, 1)).solved);
    EXPECT_FALSE(solveOne({}).solved);
}

}  // namespace
}  // namespace djpete::backend
