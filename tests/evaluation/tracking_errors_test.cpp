#include "djpete/evaluation/tracking_errors.h"

#include <functional>

#include "tracking_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

using Ids = std::vector<int64_t>;

TrackingCounts countsOf(const TrackingPair& pair, std::size_t limit = 0) {
    return evaluateTracking({pair}, {}).limits.at(limit).counts;
}

/// FP, FN, IDS, FRAG.
std::vector<std::size_t> errorsOf(const TrackingPair& pair, std::size_t limit = 0) {
    const TrackingCounts c = countsOf(pair, limit);
    return {c.falsePositives, c.misses, c.switches, c.fragments};
}
using Errors = std::vector<std::size_t>;

const Ids kPerfect(10, 7);

/// A car tracked over ten frames without a fault.
TrackingPair perfectDrive() { return drive(10, kPerfect); }

}  // namespace

TEST(TrackingErrors, PerfectTracksHaveNoError) {
    const auto errors = evaluateTracking({perfectDrive()}, {});
    for (const auto& limit : errors.limits) {
        EXPECT_EQ(limit.counts.labels, 10U);
        EXPECT_EQ(limit.counts.matches, 10U);
        EXPECT_DOUBLE_EQ(limit.counts.mota().value(), 1);
        EXPECT_NEAR(limit.counts.motp().value(), 1, 1e-12);
        EXPECT_DOUBLE_EQ(limit.counts.recall().value(), 1);
        EXPECT_DOUBLE_EQ(limit.counts.precision().value(), 1);
        EXPECT_EQ(limit.score, 0.75);
        // Each of the 10 matches is a threshold, the first is discarded: recalls 1/40 .. 9/40.
        EXPECT_NEAR(limit.sAmota.value(), 9.0 / 40, 1e-12);
    }
    EXPECT_EQ(errorsOf(perfectDrive()), (Errors{0, 0, 0, 0}));
    EXPECT_NEAR(errors.hota.hota, 1, 1e-12);
}

TEST(TrackingErrors, ScaledMotaOfAPerfectDriveIsOneIfEveryRecallIsSampled) {
    // With 80 matches the k-th of 41 thresholds is taken at match 2k (1, 2, 4, 6, ... 80).
    const auto errors = evaluateTracking({drive(80, Ids(80, 7))}, {});
    EXPECT_NEAR(errors.limits[0].sAmota.value(), 1, 1e-12);
}

TEST(TrackingErrors, ScaledMotaCountsRecallsThatAreNotReachedAsZero) {
    // 40 of 80 labels are found, the first of each two. Match i = 0..39 has recall (i+1)/80; the
    // k-th threshold is taken at i = 2k-1, k = 0..20: 20 are left. At each the errors are 40 misses
    // of 80 labels: 1 - (40 - (1-R) 80) / (R 80) = 1/(2R), at most 1, so R = k/40 <= 1/2 gives 1.
    Ids ids;
    for (int i = 0; i < 80; ++i) ids.push_back(i % 2 == 0 ? 7 : -1);
    const auto errors = evaluateTracking({drive(80, ids)}, {});
    EXPECT_NEAR(errors.limits[0].sAmota.value(), 0.5, 1e-12);
    EXPECT_DOUBLE_EQ(errors.limits[0].counts.mota().value(), 0.5);
}

TEST(TrackingErrors, AMissIsAMissAndInterruptsTheTrack) {
    // Row 5 is missed; row 6 is found again and row 7 too: one fragment.
    const auto pair = drive(10, {7, 7, 7, 7, 7, -1, 7, 7, 7, 7});
    EXPECT_EQ(errorsOf(pair), (Errors{0, 1, 0, 1}));
    EXPECT_DOUBLE_EQ(countsOf(pair).mota().value(), 0.9);
    EXPECT_DOUBLE_EQ(countsOf(pair).recall().value(), 0.9);
}

TEST(TrackingErrors, AMissAtEitherEndInterruptsNothing) {
    EXPECT_EQ(errorsOf(drive(10, {-1, 7, 7, 7, 7, 7, 7, 7, 7, 7})), (Errors{0, 1, 0, 0}));
    EXPECT_EQ(errorsOf(drive(10, {7, 7, 7, 7, 7, 7, 7, 7, 7, -1})), (Errors{0, 1, 0, 0}));
}

TEST(TrackingErrors, AFalseResult) {
    auto pair = perfectDrive();
    pair.results.boxes.push_back(scored(carAt(3, 9, 20), 0.75));
    EXPECT_EQ(errorsOf(pair), (Errors{1, 0, 0, 0}));
    EXPECT_DOUBLE_EQ(countsOf(pair).mota().value(), 0.9);
    EXPECT_DOUBLE_EQ(countsOf(pair).precision().value(), 10.0 / 11);
}

TEST(TrackingErrors, AFalseResultInAFrameWithoutLabels) {
    auto pair = perfectDrive();
    pair.results.boxes.push_back(scored(carAt(30, 7), 0.75));
    EXPECT_EQ(errorsOf(pair), (Errors{1, 0, 0, 0}));
}

TEST(TrackingErrors, ASwitchOfIdentity) {
    // Row 5 has another result than row 4, and row 6 is found: a switch that is a fragment too.
    const auto pair = drive(10, {7, 7, 7, 7, 7, 8, 8, 8, 8, 8});
    EXPECT_EQ(errorsOf(pair), (Errors{0, 0, 1, 1}));
    EXPECT_DOUBLE_EQ(countsOf(pair).mota().value(), 0.9);
}

TEST(TrackingErrors, ASwitchAcrossAGapIsNoneButAFragment) {
    EXPECT_EQ(errorsOf(drive(10, {7, 7, 7, 7, 7, -1, 8, 8, 8, 8})), (Errors{0, 1, 0, 1}));
}

TEST(TrackingErrors, Fragments) {
    // Found again at row 9, the last: counted after the loop.
    EXPECT_EQ(errorsOf(drive(10, {7, 7, 7, 7, 7, 7, 7, 7, -1, 7})), (Errors{0, 1, 0, 1}));
    // Found again at row 2 for one row only: none; at row 4: one.
    EXPECT_EQ(errorsOf(drive(10, {7, -1, 7, -1, 7, 7, 7, 7, 7, 7})), (Errors{0, 2, 0, 1}));
    // Two gaps.
    EXPECT_EQ(errorsOf(drive(10, {7, 7, -1, 7, 7, -1, -1, 7, 7, 7})), (Errors{0, 3, 0, 2}));
    // One row of another identity: switched there and back, two switches and two fragments.
    EXPECT_EQ(errorsOf(drive(10, {7, 7, 7, 8, 7, 7, 7, 7, 7, 7})), (Errors{0, 0, 2, 2}));
}

TEST(TrackingErrors, RowsCountNotFrames) {
    // The label has no box in frames 10..19. The rows before and after are neighbours.
    auto pair = perfectDrive();
    for (std::size_t f = 20; f < 25; ++f) {
        pair.labels.boxes.push_back(carAt(f, 1));
        pair.results.boxes.push_back(scored(carAt(f, 8), 0.75));
    }
    EXPECT_EQ(errorsOf(pair), (Errors{0, 0, 1, 1}));
}

TEST(TrackingErrors, AnIgnoredRowForgetsTheIdentityBefore) {
    auto pair = drive(10, {7, 7, 7, 7, 7, 7, 8, 8, 8, 8});
    pair.labels.boxes[5].truncation = 1;
    EXPECT_EQ(errorsOf(pair), (Errors{0, 0, 0, 0}));
    EXPECT_EQ(countsOf(pair).labels, 9U);
    EXPECT_EQ(countsOf(pair).matches, 10U) << "matches with ignored labels count as matches";
}

TEST(TrackingErrors, VansAndTruncatedOrOccludedLabelsAreNeitherMissedNorCounted) {
    const auto van = [](TrackingBox& b) { b.objectClass = djpete::obs::ObjectClass::Van; };
    const auto truncated = [](TrackingBox& b) { b.truncation = 1; };
    const auto occluded = [](TrackingBox& b) { b.occlusion = 3; };
    for (const auto& change :
         std::vector<std::function<void(TrackingBox&)>>{van, truncated, occluded}) {
        auto missed = perfectDrive();
        TrackingBox other = carAt(2, 5, 20);
        change(other);
        missed.labels.boxes.push_back(other);
        EXPECT_EQ(errorsOf(missed), (Errors{0, 0, 0, 0}));
        EXPECT_EQ(countsOf(missed).labels, 10U);
        auto found = missed;
        found.results.boxes.push_back(scored(carAt(2, 9, 20), 0.75));
        EXPECT_EQ(errorsOf(found), (Errors{0, 0, 0, 0}));
        EXPECT_EQ(countsOf(found).matches, 11U);
    }
    auto visibleEnough = perfectDrive();
    visibleEnough.labels.boxes.push_back(carAt(2, 5, 20));
    visibleEnough.labels.boxes.back().occlusion = 2;
    EXPECT_EQ(errorsOf(visibleEnough), (Errors{0, 1, 0, 0}));
}

TEST(TrackingErrors, OtherClassesAreNotLoaded) {
    auto pair = perfectDrive();
    pair.labels.boxes.push_back(carAt(2, 5, 20));
    pair.labels.boxes.back().objectClass = djpete::obs::ObjectClass::Truck;
    EXPECT_EQ(errorsOf(pair), (Errors{0, 0, 0, 0}));
    pair.results.boxes.push_back(scored(carAt(2, 9, 20), 0.75));
    EXPECT_EQ(errorsOf(pair), (Errors{1, 0, 0, 0})) << "a car on a truck is false";
    pair.results.boxes.back().objectClass = djpete::obs::ObjectClass::Truck;
    EXPECT_EQ(errorsOf(pair), (Errors{0, 0, 0, 0}));
}

TEST(TrackingErrors, UnmatchedResultsInDontCareAreasAreIgnored) {
    // The result's area in the image is 100 x 100 px; that much of it is in the area:
    for (const auto& [width, falsePositives] : {std::pair{51.0, 0U}, std::pair{50.0, 1U}}) {
        auto pair = perfectDrive();
        pair.results.boxes.push_back(scored(carAt(3, 9, 20), 0.75));
        pair.labels.dontCare.push_back({3, {0, 0, width, 500}});
        EXPECT_EQ(errorsOf(pair), (Errors{falsePositives, 0, 0, 0})) << width;
    }
    auto otherFrame = perfectDrive();
    otherFrame.results.boxes.push_back(scored(carAt(3, 9, 20), 0.75));
    otherFrame.labels.dontCare.push_back({4, {0, 0, 500, 500}});
    EXPECT_EQ(errorsOf(otherFrame), (Errors{1, 0, 0, 0}));
}

TEST(TrackingErrors, UnmatchedResultsThatAreLowInTheImageAreIgnored) {
    for (const auto& [height_px, falsePositives] : {std::pair{25.0, 0U}, std::pair{25.5, 1U}}) {
        auto pair = perfectDrive();
        pair.results.boxes.push_back(scored(carAt(3, 9, 20), 0.75));
        pair.results.boxes.back().image = {0, 100, 40, 100 + height_px};
        EXPECT_EQ(errorsOf(pair), (Errors{falsePositives, 0, 0, 0})) << height_px;
    }
    auto matched = perfectDrive();
    for (auto& box : matched.results.boxes) box.image = {0, 100, 40, 110};
    EXPECT_EQ(countsOf(matched).matches, 10U) << "matched ones count at any height";
}

TEST(TrackingErrors, UnmatchedResultsOfVansAreIgnored) {
    auto pair = perfectDrive();
    pair.results.boxes.push_back(scored(carAt(3, 9, 20), 0.75));
    pair.results.boxes.back().objectClass = djpete::obs::ObjectClass::Van;
    EXPECT_EQ(errorsOf(pair), (Errors{0, 0, 0, 0}));
}
