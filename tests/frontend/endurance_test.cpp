/// Motions and streets that are hard to follow.
#include <gtest/gtest.h>

#include "synthetic_street.h"

using namespace djpete;
using namespace djpete_test;

namespace {

struct Outcome {
    int lost = 0;
    double way_m = 0;     ///< error of the last position
    double turn_deg = 0;  ///< error of the last heading
};

Outcome drive(const SyntheticStreet& street, const std::vector<SE3>& T_world_cam) {
    frontend::VisualOdometry odometry;
    Outcome out;
    SE3 T_last;
    for (std::size_t i = 0; i < T_world_cam.size(); ++i) {
        const auto result = odometry.process(street.frame(i, T_world_cam[i]));
        out.lost += result->tracked ? 0 : 1;
        T_last = street.camera.T_vehicle_cam.inverse() * result->T_odom_cam;
    }
    const SE3 error = T_world_cam.back().inverse() * T_last;
    out.way_m = error.translation().norm();
    out.turn_deg = error.angle_rad() * 180 / M_PI;
    return out;
}

/// Steps ahead (metres) and turns to the right (radians) of each frame.
std::vector<SE3> path(std::size_t frames, double (*step_m)(std::size_t),
                      double (*turn_rad)(std::size_t)) {
    std::vector<SE3> out{SE3()};
    for (std::size_t i = 1; i < frames; ++i)
        out.push_back(out.back() * SE3(geometry::so3Exp({0, turn_rad(i), 0}), {0, 0, step_m(i)}));
    return out;
}

/// A motorway: fields of little contrast beside the road, and its far end out of reach.
SyntheticStreet motorway() {
    SyntheticStreet street;
    street.planes[1].centre.x() = -14;
    street.planes[2].centre.x() = 16;
    street.planes[3].centre.z() = 400;
    return street;
}

}  // namespace

TEST(Endurance, TwentyFiveMetresPerSecondAtTenHertz) {
    const auto T = path(
        14, [](std::size_t) { return 2.5; }, [](std::size_t) { return 0.002; });
    const auto out = drive(motorway(), T);
    EXPECT_EQ(out.lost, 0);
    EXPECT_LT(out.way_m, 0.01 * 32.5);
    EXPECT_LT(out.turn_deg, 0.15);
}

TEST(Endurance, HardBrakingBreaksTheConstantSpeedButNotTheTracks) {
    const auto T = path(
        10, [](std::size_t i) { return i < 5 ? 2.0 : 0.8; }, [](std::size_t) { return 0.0; });
    const auto out = drive(motorway(), T);
    EXPECT_EQ(out.lost, 0);
    EXPECT_LT(out.way_m, 0.015 * 12);
}

TEST(Endurance, TurningOnTheSpotThatStartsAndStopsAtOnce) {
    const auto T = path(
        12, [](std::size_t) { return 0.0; },
        [](std::size_t i) { return i % 4 < 2 ? 0.08 : 0.0; });  // 29 px or nothing
    const auto out = drive(SyntheticStreet(), T);
    EXPECT_EQ(out.lost, 0);
    EXPECT_LT(out.way_m, 0.04);
    EXPECT_LT(out.turn_deg, 0.2);
}

TEST(Endurance, FastAheadWithTextureInTheUpperHalfOnly) {
    SyntheticStreet street = motorway();
    street.planes.erase(street.planes.begin());  // no road: grey
    const auto T = path(
        12, [](std::size_t) { return 2.5; }, [](std::size_t) { return 0.0; });
    const auto out = drive(street, T);
    EXPECT_EQ(out.lost, 0);
    EXPECT_LT(out.way_m, 0.015 * 27.5);
}
