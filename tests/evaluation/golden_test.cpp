/// Two full runs of other systems on odometry 00 against figures known for them.
#include <cstdio>

#include "djpete/evaluation/frame_range.h"
#include "djpete/evaluation/trajectory_errors.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;

namespace {

std::string shown(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

/// t_rel, r_rel, ATE SE(3), not aligned, Sim(3), scale: to the printed digits.
void expectFigures(const std::filesystem::path& data, const std::string& run,
                   const std::vector<std::string>& expected) {
    const auto estimate = readTrajectory(data / ("trajectories/evo_KITTI_00_" + run + ".txt"));
    const auto truth = readTrajectory(data / "kitti/odometry/poses/00.txt");
    const auto pair = pairTrajectories(estimate, truth, std::nullopt);
    const auto e = evaluateTrajectory(pair.estimate, pair.truth);
    const std::vector<std::string> got{shown(e.t_rel_percent.value(), 3),
                                       shown(e.r_rel_deg_per_100m.value(), 3),
                                       shown(e.ate_se3_m, 3),
                                       shown(e.ate_unaligned_m, 3),
                                       shown(e.ate_sim3_m.value(), 3),
                                       shown(e.sim3_scale.value(), 4)};
    EXPECT_EQ(got, expected);
    EXPECT_EQ(e.frames, 4541U);
    EXPECT_EQ(e.segments, 3283U);
}

}  // namespace

TEST(Golden, OrbStereoRunOnOdometry00) {
    DJPETE_SHARED_OR_SKIP(data, "data");
    expectFigures(data, "ORB", {"0.700", "0.253", "1.303", "7.790", "0.938", "1.0047"});
}

TEST(Golden, SptamRunOnOdometry00) {
    DJPETE_SHARED_OR_SKIP(data, "data");
    expectFigures(data, "SPTAM", {"1.487", "0.558", "3.738", "9.225", "3.635", "1.0045"});
}
