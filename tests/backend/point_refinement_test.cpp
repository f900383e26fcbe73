/// Objects solved with and without the points of their views.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "djpete/backend/objects.h"
#include "scanned_box.h"

namespace djpete::backend {
namespace {

using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

const Vec3 kSize(4.2, 1.7, 1.5);
using Way = std::function<SE3(double)>;

/// Seen from a camera that follows a street; every detection is off by 0.3 m and 5 degrees.
ObjectProblem problemOf(const Way& T_world_obj, bool moving) {
    djpete_test::Random random(7);
    ObjectProblem problem;
    problem.all = true;
    problem.objects.emplace_back();
    auto& object = problem.objects.back();
    object.moving = moving;
    for (unsigned i = 0; i < 40; ++i) {
        ObjectProblem::Edge e;
        e.frame = {i};
        e.time_s = 0.1 * i;
        e.anchor = {i};
        e.T_world_cam = e.T_world_anchor = SE3::fromYaw(0, Vec3(0.4 * i, 0, 0));
        const SE3 T_cam_obj = e.T_world_cam.inverse() * T_world_obj(e.time_s);
        Vec6 noise;
        noise << random.normal3(0.3), 0.02 * random.normal3(1).head<2>(),
            0.087 * random.normal3(1).z();
        e.T_cam_obj = T_cam_obj * SE3::exp(noise);
        e.information = obs::diagonalInformation(Vec3::Constant(0.3), Vec3(0.02, 0.02, 0.087));
        e.size_m = kSize + random.normal3(0.03);
        e.points = std::make_shared<obs::ObjectPoints>(
            djpete_test::scannedBox(T_cam_obj, kSize, Vec3(0, 0, 0.2), random, 0.2));
        object.edges.push_back(e);
    }
    return problem;
}

struct Errors {
    double centre_m, yaw_rad, speed_mps;
};

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v.at(v.size() / 2);
}

Errors errorsOf(const ObjectProblem& problem, const Way& T_world_obj, double speed_mps,
                bool usePoints) {
    ObjectOptions options;
    options.usePoints = usePoints;
    const auto update = solve(problem, options).objects.at(0);
    EXPECT_TRUE(update.solved);
    EXPECT_EQ(update.moving, problem.objects[0].moving);
    std::vector<double> centre, yaw, speed;
    for (const auto& state : update.states) {
        const auto& e = problem.objects[0].edges.at(state.frame.value);
        const auto& anchor = problem.objects[0].edges.at(state.anchor.value);
        const SE3 apart =
            T_world_obj(e.time_s).inverse() * anchor.T_world_anchor * state.T_anchor_obj;
        centre.push_back(apart.translation().norm());
        yaw.push_back(std::abs(apart.yaw_rad()));
        speed.push_back(std::abs(state.twist.x() - speed_mps));
    }
    return {median(centre), median(yaw), median(speed)};
}

SE3 parked(double) { return SE3::fromYaw(0.1, {14, 4, -0.9}); }
SE3 oncoming(double time_s) {
    return SE3::fromYaw(M_PI - 0.02 * time_s, {50 - 7 * time_s, 4, -0.9});
}

TEST(PointRefinement, aStandingCarIsPlacedToFiveCentimetres) {
    const auto problem = problemOf(parked, false);
    const Errors without = errorsOf(problem, parked, 0, false);
    const Errors with = errorsOf(problem, parked, 0, true);
    EXPECT_LT(with.centre_m, 0.05);
    EXPECT_LT(with.yaw_rad, 0.5 * M_PI / 180);
    EXPECT_LT(with.centre_m, without.centre_m);
}

TEST(PointRefinement, aMovingCarToo) {
    const auto problem = problemOf(oncoming, true);
    const Errors without = errorsOf(problem, oncoming, 7, false);
    const Errors with = errorsOf(problem, oncoming, 7, true);
    EXPECT_LT(with.centre_m, 0.06);
    EXPECT_LT(with.yaw_rad, M_PI / 180);
    EXPECT_LT(with.speed_mps, 0.3);
    EXPECT_LT(with.centre_m, 0.7 * without.centre_m);
}

TEST(PointRefinement, withoutPointsTheOptionChangesNothing) {
    for (const Way& way : {Way(parked), Way(oncoming)}) {
        auto problem = problemOf(way, way(0).translation().x() > 20);
        for (auto& e : problem.objects[0].edges) e.points.reset();
        ObjectOptions off, on;
        off.usePoints = false;
        const auto a = solve(problem, off).objects.at(0), b = solve(problem, on).objects.at(0);
        ASSERT_EQ(a.states.size(), b.states.size());
        EXPECT_EQ(a.size_m, b.size_m);
        for (std::size_t i = 0; i < a.states.size(); ++i) {
            EXPECT_EQ(a.states[i].T_anchor_obj.matrix(), b.states[i].T_anchor_obj.matrix());
        }
    }
}

}  // namespace
}  // namespace djpete::backend
