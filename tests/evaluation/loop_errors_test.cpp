#include "djpete/evaluation/loop_errors.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "djpete/obs/errors.h"

namespace djpete::evaluation {
namespace {

using geometry::SE3;

/// Twice round a circle of 300 frames, 1 m a frame; the second lap half a metre outside.
Trajectory twoLaps() {
    Trajectory out;
    for (int i = 0; i < 600; ++i) {
        const double angle = 2 * M_PI * i / 300;
        const double r = 300 / (2 * M_PI) + (i < 300 ? 0 : 0.5);
        out.push_back(
            {geometry::so3Exp({0, -angle, 0}), {r * std::cos(angle), 0, r * std::sin(angle)}});
    }
    return out;
}

LoopRow pairOf(const Trajectory& truth, std::size_t older, std::size_t newer) {
    LoopRow row;
    row.olderFrame = older;
    row.newerFrame = newer;
    row.T_older_newer = truth[older].inverse() * truth[newer];
    return row;
}

TEST(LoopErrors, aRevisitIsFoundByAPairInIt) {
    const auto truth = twoLaps();
    auto errors = evaluateLoops({}, truth, "loops.csv");
    ASSERT_EQ(errors.revisits.size(), 1U);
    EXPECT_NEAR(static_cast<double>(errors.revisits[0].first), 298, 2);
    EXPECT_EQ(errors.revisits[0].last, 599U);
    EXPECT_EQ(errors.found, 0U);
    errors = evaluateLoops({pairOf(truth, 50, 350)}, truth, "loops.csv");
    EXPECT_EQ(errors.found, 1U);
    EXPECT_EQ(errors.pairs, 1U);
    EXPECT_EQ(errors.wrong, 0U);
    EXPECT_NEAR(*errors.error_m.median, 0, 1e-9);
}

TEST(LoopErrors, aWrongPairCountsAndFindsNothing) {
    const auto truth = twoLaps();
    auto row = pairOf(truth, 50, 350);
    row.T_older_newer.translation().x() += 1.5;
    const auto errors = evaluateLoops({row}, truth, "loops.csv");
    EXPECT_EQ(errors.wrong, 1U);
    EXPECT_EQ(errors.found, 0U);
    EXPECT_NEAR(*errors.error_m.median, 1.5, 1e-9);
}

TEST(LoopErrors, theOppositeDirectionIsNoRevisit) {
    auto truth = twoLaps();
    truth.resize(580);  // no lap meets its own start
    truth.erase(truth.begin(), truth.begin() + 20);
    for (std::size_t i = 280; i < 600; ++i) {
        truth[i] = truth[i] * SE3(geometry::so3Exp({0, M_PI, 0}), {0, 0, 0});
    }
    EXPECT_TRUE(evaluateLoops({}, truth, "loops.csv").revisits.empty());
}

TEST(LoopErrors, whatCannotBeReadIsTold) {
    const auto file = std::filesystem::temp_directory_path() / "djpete_loops_test.csv";
    const auto says = [&](const std::string& text) {
        std::ofstream(file) << text;
        try {
            const auto rows = readLoopsCsv(file.string());
            evaluateLoops(rows, twoLaps(), file.string());
        } catch (const obs::InputError& e) {
            return std::string(e.what());
        }
        return std::string("nothing");
    };
    const std::string header =
        "older_drive,older_frame,newer_drive,newer_frame,features,near,...\n";
    EXPECT_THAT(says("x\n"), testing::HasSubstr("expected the header"));
    EXPECT_THAT(says(header + "1,2,3\n"), testing::HasSubstr(":2: expected 16 columns"));
    EXPECT_THAT(says(header + "0,5,0,9,30,2,0,0.1,0.1,0,0,0,0,0,0,1\n"),
                testing::HasSubstr("expected 0 or 1 as near"));
    EXPECT_THAT(says(header + "0,5,0,900,30,1,0,0.1,0.1,0,0,0,0,0,0,1\n"),
                testing::HasSubstr("frame 900 is not among the 600 frames"));
    EXPECT_EQ(says(header + "0,5,0,9,30,1,0,0.1,0.1,0,0,0,0,0,0,1\n"), "nothing");
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace djpete::evaluation
