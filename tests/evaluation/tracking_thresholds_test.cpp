/// Overlaps, limits, score thresholds and several drives.
#include "djpete/evaluation/tracking_errors.h"
#include "tracking_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

using Ids = std::vector<int64_t>;

/// Mean overlap of one label and one result in two frames (one match alone has no threshold).
std::optional<double> overlapOf(const TrackingBox& label, const TrackingBox& result,
                                OverlapKind kind = OverlapKind::Volume) {
    TrackingPair pair;
    for (std::size_t f = 0; f < 2; ++f) {
        pair.labels.boxes.push_back(label);
        pair.results.boxes.push_back(scored(result, 1));
        pair.labels.boxes.back().frame = pair.results.boxes.back().frame = f;
    }
    TrackingCriteria criteria;
    criteria.overlap = kind;
    return evaluateTracking({pair}, criteria).limits.at(0).counts.motp();
}

TrackingBox turnedCar(double ry_rad, const Vec3& bottom_cam) {
    TrackingBox box = carAt(0, 1);
    box.T_cam_obj = labelPose(bottom_cam, box.size_m.z(), ry_rad);
    return box;
}

}  // namespace

TEST(TrackingThresholds, OverlapsByHand) {
    const Vec3 at(3, 1.6, 20);
    EXPECT_NEAR(overlapOf(turnedCar(0, at), turnedCar(0, at + Vec3(1, 0, 0))).value(), 0.6, 1e-12)
        << "3 of 5 m";
    EXPECT_NEAR(overlapOf(turnedCar(0, at), turnedCar(M_PI / 2, at)).value(), 1.0 / 3, 1e-12)
        << "2 x 2 m of 8 + 8 - 4";
    EXPECT_NEAR(overlapOf(turnedCar(0, at), turnedCar(M_PI, at)).value(), 1, 1e-12)
        << "front and back are the same";
    const TrackingBox higher = turnedCar(0, at - Vec3(0, 0.75, 0));
    EXPECT_NEAR(overlapOf(turnedCar(0, at), higher).value(), 1.0 / 3, 1e-12) << "0.75 of 2.25 m";
    EXPECT_NEAR(overlapOf(turnedCar(0, at), higher, OverlapKind::BirdsEye).value(), 1, 1e-12);
    TrackingBox taller = turnedCar(0, at);
    taller.size_m.z() = 3;
    taller.T_cam_obj = labelPose(at, 3, 0);
    EXPECT_NEAR(overlapOf(turnedCar(0, at), taller).value(), 0.5, 1e-12)
        << "both stand on the same ground";
}

TEST(TrackingThresholds, RotationTurnsAboutTheCamerasY) {
    // At rotation_y = 0.7 the length points along (cos, 0, -sin): moved 2 m along it, 2 of 6 m are
    // common; moved across, nothing (the car is 2 m wide).
    const Vec3 at(3, 1.6, 20), along(std::cos(0.7), 0, -std::sin(0.7)),
        across(std::sin(0.7), 0, std::cos(0.7));
    const TrackingBox label = turnedCar(0.7, at);
    EXPECT_NEAR(overlapOf(label, turnedCar(0.7, at + 2 * along)).value(), 1.0 / 3, 1e-12);
    EXPECT_FALSE(overlapOf(label, turnedCar(0.7, at + 2 * across)).has_value());
}

TEST(TrackingThresholds, TheLimitDecidesWhatIsAMatch) {
    // Rows 5..9 are 2 m off: overlap 1/3, a match at 0.25, at 0.5 a miss and a false result each.
    auto pair = drive(10, Ids(10, 7));
    for (std::size_t f = 5; f < 10; ++f) pair.results.boxes[f] = scored(carAt(f, 7, 2), 0.75);
    const auto errors = evaluateTracking({pair}, {});
    const TrackingCounts &at25 = errors.limits.at(0).counts, &at50 = errors.limits.at(1).counts;
    EXPECT_EQ(at25.matches, 10U);
    EXPECT_NEAR(at25.motp().value(), (5 + 5.0 / 3) / 10, 1e-12);
    EXPECT_EQ(at50.matches, 5U);
    EXPECT_EQ(at50.misses, 5U);
    EXPECT_EQ(at50.falsePositives, 5U);
    EXPECT_DOUBLE_EQ(at50.mota().value(), 0);
    EXPECT_NEAR(at50.motp().value(), 1, 1e-12);
}

TEST(TrackingThresholds, AsManyPairsAsPossibleCountMoreThanTheirOverlap) {
    // Labels at x = 0 and 3, results at 1.4 and -1.5. Alone 0 and 1.4 overlap best (0.48), but then
    // the others have no partner: 0 with -1.5 (2.5 of 5.5 m) and 3 with 1.4 (2.4 of 5.6 m).
    TrackingPair pair;
    for (std::size_t f = 0; f < 2; ++f) {
        pair.labels.boxes.push_back(carAt(f, 1, 0));
        pair.labels.boxes.push_back(carAt(f, 2, 3));
        pair.results.boxes.push_back(scored(carAt(f, 7, 1.4), 1));
        pair.results.boxes.push_back(scored(carAt(f, 8, -1.5), 1));
    }
    const TrackingCounts counts = evaluateTracking({pair}, {}).limits.at(0).counts;
    EXPECT_EQ(counts.matches, 4U);
    EXPECT_NEAR(counts.motp().value(), (2.5 / 5.5 + 2.4 / 5.6) / 2, 1e-12);
}

TEST(TrackingThresholds, WholeTracksAreDroppedByTheirMeanScore) {
    // The false track has one box surer than all of the true one, but is less sure on average.
    auto pair = drive(10, Ids(10, 7));
    pair.results.boxes.push_back(scored(carAt(0, 9, 20), 0.99));
    pair.results.boxes.push_back(scored(carAt(1, 9, 20), 0.01));
    const auto dropped = evaluateTracking({pair}, {}).limits.at(0);
    EXPECT_EQ(dropped.counts.falsePositives, 0U);
    EXPECT_NEAR(dropped.score.value(), 0.75, 1e-12);
    pair.results.boxes.back().score = 0.9;  // mean 0.945: nothing can drop it and keep the true one
    EXPECT_EQ(evaluateTracking({pair}, {}).limits.at(0).counts.falsePositives, 2U);
}

TEST(TrackingThresholds, TheBestThresholdMayCostMatches) {
    // Track 7 (score 0.75) covers rows 0..7, track 8 (0.25) rows 8 and 9. Three false boxes of 0.5
    // come with track 8 only if the threshold is 0.25: MOTA 1 - 3/10 there, 1 - 2/10 at 0.75.
    auto pair = drive(10, {7, 7, 7, 7, 7, 7, 7, 7, 8, 8});
    for (std::size_t f = 8; f < 10; ++f) pair.results.boxes[f].score = 0.25;
    for (std::size_t f = 0; f < 3; ++f) pair.results.boxes.push_back(scored(carAt(f, 9, 20), 0.5));
    const auto best = evaluateTracking({pair}, {}).limits.at(0);
    EXPECT_NEAR(best.score.value(), 0.75, 1e-12);
    EXPECT_EQ(best.counts.misses, 2U);
    EXPECT_EQ(best.counts.falsePositives, 0U);
    EXPECT_DOUBLE_EQ(best.counts.mota().value(), 0.8);
}

TEST(TrackingThresholds, DrivesShareTheThresholdButNoIdentities) {
    // Drive a: ids 7 and scores 0.75, perfect. Drive b: the same ids, scores 0.25, five false boxes
    // of 0.25 and two misses. Alone b is best with all (1 - 7/10). Together: threshold 0.75 loses
    // 10 of 20 labels, 0.25 has 7 errors.
    const auto a = drive(10, Ids(10, 7));
    auto b = drive(10, {7, 7, 7, 7, 7, 7, 7, 7, -1, -1});
    b.labels.name = "0001";
    for (auto& box : b.results.boxes) box.score = 0.25;
    for (std::size_t f = 0; f < 5; ++f) b.results.boxes.push_back(scored(carAt(f, 9, 20), 0.25));
    const auto errors = evaluateTracking({a, b}, {});
    const auto& joint = errors.limits.at(0);
    EXPECT_NEAR(joint.score.value(), 0.25, 1e-12);
    EXPECT_EQ(joint.counts.labels, 20U);
    EXPECT_DOUBLE_EQ(joint.counts.mota().value(), 1 - 7.0 / 20);
    EXPECT_EQ(joint.counts.switches + joint.counts.fragments, 0U);
    ASSERT_EQ(errors.sequences.size(), 2U);
    EXPECT_EQ(errors.sequences[1].name, "0001");
    EXPECT_DOUBLE_EQ(errors.sequences[0].joint[0].mota().value(), 1);
    EXPECT_DOUBLE_EQ(errors.sequences[1].joint[0].mota().value(), 0.3);
    EXPECT_NEAR(errors.sequences[0].own[0].score.value(), 0.75, 1e-12);
    EXPECT_DOUBLE_EQ(errors.sequences[1].own[0].counts.mota().value(), 0.3);
}

TEST(TrackingThresholds, WithoutScoresAllTracksCountAndThereIsNoScaledMota) {
    auto pair = drive(10, Ids(10, 7));
    for (auto& box : pair.results.boxes) box.score.reset();
    pair.results.boxes.push_back(carAt(3, 9, 20));
    const auto figures = evaluateTracking({pair}, {}).limits.at(0);
    EXPECT_FALSE(figures.sAmota.has_value());
    EXPECT_DOUBLE_EQ(figures.counts.mota().value(), 0.9);
}

TEST(TrackingThresholds, NothingFoundIsAllMissed) {
    auto pair = drive(10, Ids(10, -1));
    const auto errors = evaluateTracking({pair}, {});
    EXPECT_EQ(errors.limits[0].counts.misses, 10U);
    EXPECT_DOUBLE_EQ(errors.limits[0].counts.mota().value(), 0);
    EXPECT_FALSE(errors.limits[0].counts.motp().has_value());
    EXPECT_FALSE(errors.limits[0].score.has_value());
    EXPECT_EQ(errors.hota.hota, 0);
    std::swap(pair.labels.boxes, pair.results.boxes);
    EXPECT_EQ(evaluateTracking({pair}, {}).limits[0].counts.falsePositives, 10U);
    EXPECT_FALSE(evaluateTracking({pair}, {}).limits[0].counts.mota().has_value());
}

TEST(TrackingThresholds, RefusesWhatCannotBeEvaluated) {
    EXPECT_INPUT_ERROR(evaluateTracking({}, {}), "at least one drive");
    auto pair = drive(2, {7, 7});
    std::swap(pair.labels.boxes, pair.results.boxes);
    EXPECT_INPUT_ERROR(evaluateTracking({pair}, {}), "0000", "have scores");
}
