#include "djpete/evaluation/hota.h"

#include "tracking_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

Hota hotaFor(const TrackingPair& pair) { return evaluateTracking({pair}, {}).hota; }

}  // namespace

TEST(Hota, PerfectTracks) {
    const Hota h = hotaFor(drive(4, {7, 7, 7, 7}));
    for (const double v : {h.hota, h.detA, h.assA, h.locA}) EXPECT_NEAR(v, 1, 1e-12);
}

TEST(Hota, ATrackSplitInHalves) {
    // Each match sees 2 boxes together and 2 of the label's without that result: 2 / (2 + 2).
    const Hota h = hotaFor(drive(4, {7, 7, 8, 8}));
    EXPECT_NEAR(h.detA, 1, 1e-12);
    EXPECT_NEAR(h.assA, 0.5, 1e-12);
    EXPECT_NEAR(h.hota, std::sqrt(0.5), 1e-12);
}

TEST(Hota, AMissAndAFalseBox) {
    // Detection 3 / (3 + 1 missed + 1 false), association 3 / (3 + 1 missed).
    auto pair = drive(4, {7, 7, 7, -1});
    pair.results.boxes.push_back(scored(carAt(0, 9, 20), 0.75));
    const Hota h = hotaFor(pair);
    EXPECT_NEAR(h.detA, 0.6, 1e-12);
    EXPECT_NEAR(h.assA, 0.75, 1e-12);
    EXPECT_NEAR(h.hota, std::sqrt(0.6 * 0.75), 1e-12);
}

TEST(Hota, ABoxThatIsOffMatchesAtLowThresholdsOnly) {
    // All boxes 1 m off: similarity 3/5, so the thresholds 0.05 .. 0.60 are reached, 12 of 19. At
    // each of them all is perfect but the place; at the 7 others nothing is matched.
    auto pair = drive(4, {7, 7, 7, 7});
    for (std::size_t f = 0; f < 4; ++f) pair.results.boxes[f] = scored(carAt(f, 7, 1), 0.75);
    const Hota h = hotaFor(pair);
    EXPECT_NEAR(h.detA, 12.0 / 19, 1e-12);
    EXPECT_NEAR(h.assA, 12.0 / 19, 1e-12);
    EXPECT_NEAR(h.hota, 12.0 / 19, 1e-12);
    EXPECT_NEAR(h.locA, (12 * 0.6 + 7) / 19, 1e-12);
}

TEST(Hota, PairsFollowTheWholeTracks) {
    // Label 1 and result 7 are together in frames 0..3. In frame 4 the result is 1.7 m from label 1
    // (2.3 / 5.7 = 0.404) and 1.3 m from label 2 (2.7 / 5.3 = 0.509), seen only there. It still is
    // label 1: at the 8 thresholds up to 0.40 5 of 6 boxes match, all with one identity; at the 11
    // others 4 match, 2 are missed and 1 is false, and association is 4 / (5 + 5 - 4).
    auto pair = drive(5, {7, 7, 7, 7, 7});
    pair.labels.boxes.push_back(carAt(4, 2, 3));
    pair.results.boxes[4] = scored(carAt(4, 7, 1.7), 0.75);
    const Hota h = hotaFor(pair);
    EXPECT_NEAR(h.detA, (8 * 5.0 / 6 + 11 * 4.0 / 7) / 19, 1e-12);
    EXPECT_NEAR(h.assA, (8 * 1.0 + 11 * 2.0 / 3) / 19, 1e-12);
    EXPECT_NEAR(h.hota, (8 * std::sqrt(5.0 / 6) + 11 * std::sqrt(4.0 / 7 * 2 / 3)) / 19, 1e-12);
    EXPECT_NEAR(h.locA, (8 * (4 + 2.3 / 5.7) / 5 + 11) / 19, 1e-12);
}

TEST(Hota, TwoTracksThatChangeIdentities) {
    // Both labels are found always, by 7 and 8, changed over in the second half of 4 frames: each
    // match sees 2 boxes together of 4 + 4 - 2.
    auto pair = drive(4, {7, 7, 8, 8});
    for (std::size_t f = 0; f < 4; ++f) {
        pair.labels.boxes.push_back(carAt(f, 2, 20));
        pair.results.boxes.push_back(scored(carAt(f, f < 2 ? 8 : 7, 20), 0.75));
    }
    const Hota h = hotaFor(pair);
    EXPECT_NEAR(h.detA, 1, 1e-12);
    EXPECT_NEAR(h.assA, 1.0 / 3, 1e-12);
}

TEST(Hota, IgnoredLabelsTheirResultsAndIgnoredResultsDoNotCount) {
    auto pair = drive(4, {7, 7, 7, 7});
    pair.labels.boxes.push_back(carAt(2, 2, 20));
    pair.labels.boxes.back().objectClass = djpete::obs::ObjectClass::Van;
    pair.results.boxes.push_back(scored(carAt(2, 9, 20), 0.75));  // on the van
    pair.results.boxes.push_back(scored(carAt(1, 5, 40), 0.75));  // low in the image
    pair.results.boxes.back().image = {0, 0, 30, 20};
    EXPECT_NEAR(hotaFor(pair).hota, 1, 1e-12);
    pair.results.boxes.back().image = {0, 0, 30, 60};
    EXPECT_NEAR(hotaFor(pair).detA, 0.8, 1e-12) << "4 of 5";
}

TEST(Hota, DrivesAddUp) {
    // 4 perfect matches and, in the other drive, the track split in halves: the mean over 8 matches
    // is (4 * 1 + 4 * 0.5) / 8. The same identities in both drives are different tracks.
    const auto errors = evaluateTracking({drive(4, {7, 7, 7, 7}), drive(4, {7, 7, 8, 8})}, {});
    EXPECT_NEAR(errors.hota.assA, 0.75, 1e-12);
    EXPECT_NEAR(errors.sequences[0].hota.assA, 1, 1e-12);
    EXPECT_NEAR(errors.sequences[1].hota.assA, 0.5, 1e-12);
}
