/// What the options of the object solver promise: views, size and upright priors, threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "djpete/backend/object_size.h"
#include "djpete/backend/objects.h"
#include "djpete_test/synthetic_drive.h"

namespace djpete::backend {
namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

constexpr double kSigma_m = 0.2, kSigma_rad = 0.05;
const SE3 kParked = SE3::fromYaw(0.7, {45, 6, -1});
const Vec3 kLong(5.2, 1.9, 1.9);

/// Truth of the camera at view i, and what the map believes, which drifts sideways by `drift` of
/// the way.
SE3 trueCamera(unsigned i) { return SE3::fromYaw(0.01 * i, {0.8 * i, 0, 0}); }
SE3 believedCamera(unsigned i, double drift) {
    return SE3::fromYaw(0, {0, drift * 0.8 * i, 0}) * trueCamera(i);
}

ObjectProblem::Object seen(unsigned n, uint64_t seed, double drift = 0, double speed_mps = 0) {
    djpete_test::Random random(seed);
    ObjectProblem::Object object;
    object.id = {seed};
    for (unsigned i = 0; i < n; ++i) {
        ObjectProblem::Edge e;
        e.frame = {i};
        e.time_s = 0.1 * i;
        e.anchor = {i / 3};
        e.T_world_anchor = believedCamera(i / 3 * 3, drift);
        e.T_world_cam = believedCamera(i, drift);
        const SE3 T_world_obj = kParked * SE3::fromYaw(0, {speed_mps * e.time_s, 0, 0});
        Vec6 noise;
        noise << random.normal3(kSigma_m), random.normal3(kSigma_rad);
        e.T_cam_obj = trueCamera(i).inverse() * T_world_obj * SE3::exp(noise);
        e.information =
            obs::diagonalInformation(Vec3::Constant(kSigma_m), Vec3::Constant(kSigma_rad));
        e.size_m = kLong;
        object.edges.push_back(e);
    }
    return object;
}

ObjectUpdate::Object solveOne(const ObjectProblem::Object& object, bool all = true,
                              const ObjectOptions& options = {}) {
    ObjectProblem problem;
    problem.all = all;
    problem.objects.push_back(object);
    return solve(problem, options).objects.at(0);
}

SE3 firstPose(const ObjectProblem::Object& in, const ObjectUpdate::Object& out) {
    for (const auto& e : in.edges) {
        if (e.anchor == out.states.at(0).anchor) {
            return e.T_world_anchor * out.states[0].T_anchor_obj;
        }
    }
    ADD_FAILURE() << "a state with an anchor that no edge has";
    return SE3();
}

TEST(ObjectViews, areThereForStandingObjectsInTheLastSolveOnly) {
    const auto parked = seen(30, 1);
    const auto last = solveOne(parked);
    ASSERT_EQ(last.views.size(), 30U);
    EXPECT_EQ(last.views.begin()->first, obs::FrameId{0});
    EXPECT_TRUE(solveOne(parked, false).views.empty());
    ObjectOptions without;
    without.cameraDrift = 0;
    EXPECT_TRUE(solveOne(parked, true, without).views.empty());
    const auto driving = solveOne(seen(30, 1, 0, 8));
    EXPECT_TRUE(driving.moving);
    EXPECT_TRUE(driving.views.empty());
}

TEST(ObjectViews, seeTheObjectWhereTheCameraSawItWhenCamerasDrift) {
    double onePose_m = 0, views_m = 0, raw_m = 0;
    const unsigned n = 40;
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        const auto in = seen(n, seed, 0.03);
        const auto out = solveOne(in);
        ASSERT_TRUE(out.solved);
        ASSERT_FALSE(out.moving);
        ASSERT_EQ(out.views.size(), n);
        const SE3 T_world_obj = firstPose(in, out);
        for (unsigned i = 0; i < n; ++i) {
            const Vec3 truth = (trueCamera(i).inverse() * kParked).translation();
            const SE3 T_cam_obj = in.edges[i].T_world_cam.inverse() * T_world_obj;
            onePose_m += (T_cam_obj.translation() - truth).norm() / (10 * n);
            views_m += (out.views.at({i}).translation() - truth).norm() / (10 * n);
            raw_m += (in.edges[i].T_cam_obj.translation() - truth).norm() / (10 * n);
        }
    }
    EXPECT_LT(views_m, 0.7 * onePose_m);
    EXPECT_LT(views_m, 0.7 * raw_m);
}

TEST(ObjectViews, withGoodCamerasTheyAreTheOnePose) {
    const auto in = seen(40, 2);
    const auto out = solveOne(in);
    const SE3 T_world_obj = firstPose(in, out);
    for (unsigned i = 0; i < 40; ++i) {
        const SE3 T_world_view = in.edges[i].T_world_cam * out.views.at({i});
        EXPECT_LT((T_world_view.translation() - T_world_obj.translation()).norm(), 0.15);
    }
}

TEST(ObjectSizes, thePriorPullsFewViewsAndNotMany) {
    ObjectOptions without;
    without.sizePrior = 0;
    const double usual_m = usualSize(obs::ObjectClass::Car).mean_m.x();
    const auto few = seen(3, 3), many = seen(200, 3);
    EXPECT_TRUE(solveOne(few, true, without).size_m.isApprox(kLong, 1e-9));
    const double pulled_m = solveOne(few).size_m.x();
    EXPECT_LT(pulled_m, kLong.x() - 0.1);
    EXPECT_GT(pulled_m, usual_m);
    EXPECT_NEAR(solveOne(many).size_m.x(), kLong.x(), 0.03);
}

TEST(ObjectSizes, unsureDetectionsSayLittleOfIt) {
    auto in = seen(20, 4);
    for (std::size_t i = 0; i < 10; ++i) {  // far away: five times as unsure, and too short
        in.edges[i].information /= 25;
        in.edges[i].size_m.x() = 4.6;
    }
    ObjectOptions without;
    without.sizePrior = 0;
    EXPECT_GT(solveOne(in, true, without).size_m.x(), 5.1);
}

TEST(ObjectUpright, aLeaningStandingObjectIsPutUp) {
    auto in = seen(6, 5);
    for (auto& e : in.edges) {
        e.T_cam_obj = e.T_cam_obj * SE3(geometry::so3Exp({0.15, 0, 0}), Vec3::Zero());
    }
    const auto tilt = [&](double sigma_rad, const ObjectProblem::Object& object) {
        ObjectOptions o;
        o.uprightSigma_rad = sigma_rad;
        const SE3 T_world_obj = firstPose(object, solveOne(object, true, o));
        const Vec3 up_world = object.edges[0].up_world;
        return std::acos(std::min(1.0, T_world_obj.rotation().col(2).dot(up_world)));
    };
    EXPECT_GT(tilt(0, in), 0.1);
    EXPECT_LT(tilt(0.001, in), 0.01);
    EXPECT_LT(tilt(0.01, in), tilt(0.05, in));
    EXPECT_LT(tilt(0.05, in), tilt(0, in));
    // Up is the vehicle's: on a slope an object stands as the vehicle does.
    const Vec3 slope_world = geometry::so3Exp({0.15, 0, 0}) * Vec3(0, 0, 1);
    for (auto& e : in.edges) e.up_world = slope_world;
    EXPECT_LT(tilt(0.001, in), 0.01);
}

TEST(ObjectThreads, haveNoInfluenceOnResults) {
    ObjectProblem problem;
    for (uint64_t k = 0; k < 40; ++k) {
        problem.objects.push_back(seen(20, k, 0.01, k % 2 == 1 ? 7 : 0));
    }
    for (const bool all : {false, true}) {
        problem.all = all;
        ObjectOptions o;
        o.threads = 1;
        const auto expected = solve(problem, o);
        for (const unsigned threads : {0U, 2U, 3U, 8U}) {
            o.threads = threads;
            const auto update = solve(problem, o);
            ASSERT_EQ(update.objects.size(), 40U);
            for (std::size_t k = 0; k < 40; ++k) {
                const auto &a = expected.objects[k], &b = update.objects[k];
                EXPECT_EQ(a.id, b.id);
                EXPECT_EQ(a.moving, k % 2 == 1);
                EXPECT_EQ(a.moving, b.moving);
                EXPECT_EQ(a.size_m, b.size_m);
                ASSERT_EQ(a.states.size(), b.states.size());
                for (std::size_t i = 0; i < a.states.size(); ++i) {
                    EXPECT_EQ(a.states[i].T_anchor_obj.matrix(), b.states[i].T_anchor_obj.matrix());
                    EXPECT_EQ(a.states[i].twist, b.states[i].twist);
                    EXPECT_EQ(a.states[i].covariance, b.states[i].covariance);
                }
                ASSERT_EQ(a.views.size(), b.views.size());
                for (const auto& [frame, T] : a.views) {
                    EXPECT_EQ(T.matrix(), b.views.at(frame).matrix());
                }
            }
        }
    }
}

}  // namespace
}  // namespace djpete::backend
