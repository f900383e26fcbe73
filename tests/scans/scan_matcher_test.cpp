#include "djpete/scans/scan_matcher.h"

#include <gmock/gmock.h>

#include "made_up_street.h"

namespace djpete::scans {
namespace {

using geometry::Mat6;
using made_up::SE3;
using made_up::Vec3;
using made_up::Vec6;

constexpr double kDegree = M_PI / 180;

/// A bend: 2 m and 2 degrees a keyframe, pitching a little.
SE3 placeOf(int keyframe) {
    SE3 T;
    for (int i = 0; i < keyframe; ++i) {
        Vec6 step;
        step << 2, 0, 0, 0, (i % 2 == 0 ? 0.3 : -0.3) * kDegree, (i < 6 ? 2 : -2) * kDegree;
        T = T * SE3::exp(step);
    }
    return T;
}

/// Odometry that is wrong by centimetres and tenths of degrees at each keyframe, each its own way.
SE3 odometryOf(int keyframe) {
    const double s = keyframe % 2 == 0 ? 1 : -1;
    Vec6 wrong;
    wrong << 0.05 * s, 0.03 * s, -0.04 * s, 0.2 * s * kDegree, -0.1 * s * kDegree,
        0.3 * s * kDegree;
    return keyframe == 0 ? placeOf(0) : placeOf(keyframe) * SE3::exp(wrong);
}

struct Errors {
    int motions = 0;
    double largest_m = 0, largest_rad = 0;
    double squared = 0;  ///< mean of e^T I e
};

/// Drives `keyframes` keyframes and compares each motion with the truth. `spoil` may change a scan.
template <class Spoil>
Errors drive(const made_up::Street& street, int keyframes, Spoil&& spoil,
             const ScanOptions& options = {}) {
    ScanMatcher matcher(options);
    Errors out;
    for (int k = 0; k < keyframes; ++k) {
        auto scan = made_up::scanOf(street, placeOf(k), 0.02, 100 + uint64_t(k));
        spoil(scan, k);
        const auto match = matcher.addKeyframe({uint64_t(3 * k)}, prepareScan(scan, options),
                                               odometryOf(k), Vec6::Zero());
        EXPECT_EQ(match.has_value(), k > 0) << k;
        if (!match) continue;
        EXPECT_EQ(match->from.value, uint64_t(3 * (k - 1)));
        const SE3 truth = placeOf(k - 1).inverse() * placeOf(k);
        const Vec6 e = (truth.inverse() * match->T_from_vehicle).log();
        out.largest_m = std::max(out.largest_m, e.head<3>().norm());
        out.largest_rad = std::max(out.largest_rad, e.tail<3>().norm());
        out.squared += e.dot(match->information * e);
        ++out.motions;
    }
    out.squared /= std::max(out.motions, 1);
    return out;
}

TEST(ScanMatcher, MeasuresMotionInAStreet) {
    const auto errors = drive(made_up::houses(), 12, [](auto&, int) {});
    EXPECT_EQ(errors.motions, 11);
    EXPECT_LT(errors.largest_m, 0.01);
    EXPECT_LT(errors.largest_rad, 0.05 * kDegree);
}

TEST(ScanMatcher, ItsInformationIsHonest) {
    // Without what is added for real scanners; this one has only noise.
    ScanOptions options;
    options.floor_m = options.floor_rad = 1e-6;
    const auto errors = drive(
        made_up::houses(), 12, [](auto&, int) {}, options);
    EXPECT_LT(errors.squared, 9);  // of 6 degrees of freedom
    EXPECT_GT(errors.squared, 0.3);
    EXPECT_LT(drive(made_up::houses(), 12, [](auto&, int) {}).squared, 0.5 * errors.squared);
}

TEST(ScanMatcher, ThingsThatMoveDoNotPullIt) {
    // A lorry drives along, 1.5 m a keyframe faster than we do.
    const auto street = made_up::houses();
    const ScanOptions options;
    ScanMatcher matcher(options);
    for (int k = 0; k < 10; ++k) {
        auto with = street;
        const double x = 8 + 3.5 * k;
        with.boxes.push_back({{x, -5, -1.6}, {x + 12, -2.5, 2}});
        const auto scan = made_up::scanOf(with, placeOf(k), 0.02, 7 + uint64_t(k));
        const auto match = matcher.addKeyframe({uint64_t(k)}, prepareScan(scan, options),
                                               odometryOf(k), Vec6::Zero());
        if (k == 0) continue;
        ASSERT_TRUE(match) << k;
        const SE3 truth = placeOf(k - 1).inverse() * placeOf(k);
        const Vec6 e = (truth.inverse() * match->T_from_vehicle).log();
        EXPECT_LT(e.head<3>().norm(), 0.015) << k;
        EXPECT_LT(e.tail<3>().norm(), 0.08 * kDegree) << k;
    }
}

TEST(ScanMatcher, ASmoothCorridorTellsNothingAlongIt) {
    const auto street = made_up::corridor();
    const ScanOptions options;
    ScanMatcher matcher(options);
    for (int k = 0; k < 6; ++k) {
        const SE3 truth(geometry::Mat3::Identity(), Vec3(2.0 * k, 0, 0));
        const SE3 odometry(geometry::Mat3::Identity(), Vec3(2.1 * k, k % 2 == 0 ? 0 : 0.05, 0));
        const auto scan = made_up::scanOf(street, truth, 0.02, uint64_t(k));
        const auto match =
            matcher.addKeyframe({uint64_t(k)}, prepareScan(scan, options), odometry, Vec6::Zero());
        if (k == 0) continue;
        ASSERT_TRUE(match);
        const Mat6 covariance = match->information.inverse();
        EXPECT_GT(std::sqrt(covariance(0, 0)), 0.1) << k;   // along
        EXPECT_LT(std::sqrt(covariance(1, 1)), 0.01) << k;  // across
        EXPECT_LT(std::sqrt(covariance(2, 2)), 0.01) << k;  // up
        EXPECT_LT(std::sqrt(covariance(5, 5)), 0.05 * kDegree) << k;
        EXPECT_NEAR(match->T_from_vehicle.translation().y(), 0, 0.01) << k;
        // The first guess stays where nothing speaks against it.
        EXPECT_NEAR(match->T_from_vehicle.translation().x(), 2.1, 0.15) << k;
    }
}

TEST(ScanMatcher, PointsWithoutNumbersAreSurvived) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto errors = drive(made_up::houses(), 4, [&](obs::LidarScan& scan, int) {
        for (std::size_t i = 0; i < scan.points.size(); i += 3) scan.points[i].y = nan;
    });
    EXPECT_EQ(errors.motions, 3);
    EXPECT_LT(errors.largest_m, 0.01);
}

TEST(ScanMatcher, AnEmptyScanIsNoMatchAndItGoesOnAfterIt) {
    const ScanOptions options;
    ScanMatcher matcher(options);
    int matches = 0;
    for (int k = 0; k < 6; ++k) {
        obs::LidarScan scan;
        if (k != 2) scan = made_up::scanOf(made_up::houses(), placeOf(k), 0.02, uint64_t(k));
        const auto match = matcher.addKeyframe({uint64_t(k)}, prepareScan(scan, options),
                                               odometryOf(k), Vec6::Zero());
        EXPECT_EQ(match.has_value(), k == 1 || k >= 4) << k;
        matches += match ? 1 : 0;
    }
    EXPECT_EQ(matches, 3);
}

TEST(ScanMatcher, AScanOfElsewhereIsNoMatch) {
    const ScanOptions options;
    ScanMatcher matcher(options);
    const auto here = made_up::scanOf(made_up::houses(), SE3(), 0.02, 1);
    made_up::Street other;
    other.ground = false;
    other.boxes = {{{30, -4, 5}, {31, 4, 9}}};
    const auto there = made_up::scanOf(other, SE3(), 0.02, 2);
    matcher.addKeyframe({0}, prepareScan(here, options), SE3(), Vec6::Zero());
    EXPECT_FALSE(matcher.addKeyframe({1}, prepareScan(there, options), SE3(), Vec6::Zero()));
}

TEST(ScanMatcher, SameScansSameNumbers) {
    const ScanOptions options;
    ScanMatcher a(options), b(options);
    for (int k = 0; k < 4; ++k) {
        const auto scan =
            prepareScan(made_up::scanOf(made_up::houses(), placeOf(k), 0.02, uint64_t(k)), options);
        const auto x = a.addKeyframe({uint64_t(k)}, scan, odometryOf(k), Vec6::Zero());
        const auto y = b.addKeyframe({uint64_t(k)}, scan, odometryOf(k), Vec6::Zero());
        ASSERT_EQ(x.has_value(), y.has_value());
        if (!x) continue;
        EXPECT_EQ(x->T_from_vehicle.matrix(), y->T_from_vehicle.matrix());
        EXPECT_EQ(x->information, y->information);
    }
}

}  // namespace
}  // namespace djpete::scans
