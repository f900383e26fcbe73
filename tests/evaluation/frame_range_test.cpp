#include "djpete/evaluation/frame_range.h"

#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

TrajectoryFile fileOf(const std::string& name, const Trajectory& poses) {
    TrajectoryFile file;
    file.path = name;
    file.poses = poses;
    return file;
}

void expectSame(const Trajectory& a, const Trajectory& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_LT((a[i].matrix() - b[i].matrix()).norm(), 1e-12) << "row " << i;
    }
}

}  // namespace

TEST(FrameRange, ParsesHalfOpenRanges) {
    const auto range = parseFrameRange("10:25");
    EXPECT_EQ(range.begin, 10U);
    EXPECT_EQ(range.end, 25U);
    EXPECT_EQ(range.size(), 15U);
    for (const std::string bad : {"", ":", "3", "3:", ":3", "3:3", "4:3", "-1:3", "a:b", "1:2:3",
                                  "1.5:3", "0:99999999999999999999"}) {
        EXPECT_INPUT_ERROR(parseFrameRange(bad), "'" + bad + "'", "A:B");
    }
}

TEST(FrameRange, WithoutRangePosesStayAsTheyAre) {
    const auto path = windingPath(10);
    const auto moved = movedBy(SE3::fromYaw(1, {1, 2, 3}), path);
    const auto pair = pairTrajectories(fileOf("e", moved), fileOf("t", path), std::nullopt);
    expectSame(pair.estimate, moved);
    expectSame(pair.truth, path);
}

TEST(FrameRange, AnEstimateOfTheRangeAloneStartsAtTheRange) {
    const auto truth = windingPath(50);
    const Trajectory part(truth.begin() + 20, truth.begin() + 30);
    const auto pair = pairTrajectories(fileOf("e", startingAtIdentity(part)), fileOf("t", truth),
                                       FrameRange{20, 30});
    expectSame(pair.estimate, startingAtIdentity(part));
    expectSame(pair.truth, startingAtIdentity(part));
}

TEST(FrameRange, ALongerEstimateHasARowForEveryFrame) {
    const auto truth = windingPath(50);
    const Trajectory first40(truth.begin(), truth.begin() + 40);
    const Trajectory part(truth.begin() + 20, truth.begin() + 30);
    const auto moved = movedBy(SE3::fromYaw(1, {1, 2, 3}), first40);
    const auto pair = pairTrajectories(fileOf("e", moved), fileOf("t", truth), FrameRange{20, 30});
    expectSame(pair.estimate, startingAtIdentity(part));
    expectSame(pair.truth, startingAtIdentity(part));
}

TEST(FrameRange, ARangeFromZeroKeepsPosesAsGiven) {
    const auto truth = windingPath(50);
    const auto moved = movedBy(SE3::fromYaw(1, {1, 2, 3}), truth);
    const auto pair = pairTrajectories(fileOf("e", moved), fileOf("t", truth), FrameRange{0, 30});
    expectSame(pair.estimate, Trajectory(moved.begin(), moved.begin() + 30));
    expectSame(pair.truth, Trajectory(truth.begin(), truth.begin() + 30));
}

TEST(FrameRange, CountsThatDoNotFitAreRefused) {
    const auto e = fileOf("est.txt", windingPath(10)), t = fileOf("truth.txt", windingPath(50));
    EXPECT_INPUT_ERROR(pairTrajectories(e, t, std::nullopt), "est.txt", "10", "truth.txt", "50",
                       "range");
    EXPECT_INPUT_ERROR(pairTrajectories(e, t, FrameRange{0, 11}), "est.txt", "10 poses", "11");
    EXPECT_INPUT_ERROR(pairTrajectories(e, t, FrameRange{8, 12}), "est.txt", "exactly 4",
                       "at least 12");
    EXPECT_INPUT_ERROR(pairTrajectories(e, t, FrameRange{45, 55}), "truth.txt", "50 poses", "55");
}

TEST(FrameRange, TimesMustAgreeWhereBothFilesHaveThem) {
    auto e = fileOf("est.txt", windingPath(3)), t = fileOf("truth.txt", windingPath(3));
    t.stamps_s = {0, 0.1, 0.2};
    EXPECT_NO_THROW(pairTrajectories(e, t, std::nullopt));
    e.stamps_s = {0, 0.101, 0.2};
    EXPECT_NO_THROW(pairTrajectories(e, t, std::nullopt));
    e.stamps_s = {0, 0.1, 0.3};
    EXPECT_INPUT_ERROR(pairTrajectories(e, t, std::nullopt), "est.txt", "pose 2", "truth.txt");
}
