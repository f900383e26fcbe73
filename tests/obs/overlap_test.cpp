#include "djpete/obs/overlap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "djpete_test/random.h"

namespace djpete::obs {
namespace {

using geometry::SE3;
using geometry::Vec3;

TEST(Overlap, ofKnownBoxes) {
    const UprightBox a{{0, 0, 0}, 0, {4, 2, 1}};
    EXPECT_NEAR(birdsEyeOverlap(a, a), 1, 1e-12);
    EXPECT_NEAR(birdsEyeOverlap(a, {{2, 0, 0}, 0, {4, 2, 1}}), 1.0 / 3, 1e-12);
    EXPECT_NEAR(birdsEyeOverlap(a, {{0, 0, 0}, M_PI / 2, {4, 2, 1}}), 4.0 / 12, 1e-12);
    EXPECT_NEAR(birdsEyeOverlap(a, {{0, 0, 0}, M_PI, {4, 2, 1}}), 1, 1e-12);
    EXPECT_EQ(birdsEyeOverlap(a, {{4.1, 0, 0}, 0, {4, 2, 1}}), 0);
    EXPECT_NEAR(volumeOverlap(a, {{0, 0, 0.5}, 0, {4, 2, 1}}), 1.0 / 3, 1e-12);
    // A square turned by 45 degrees in one of the same width: a regular octagon.
    const UprightBox s{{100, 50, 0}, 0.3, {2, 2, 1}}, t{{100, 50, 0}, 0.3 + M_PI / 4, {2, 2, 1}};
    const double octagon = 8 * (std::sqrt(2.0) - 1);
    EXPECT_NEAR(birdsEyeOverlap(s, t), octagon / (8 - octagon), 1e-9);
    EXPECT_NEAR(imageOverlap({0, 0, 10, 10}, {5, 0, 15, 10}), 1.0 / 3, 1e-6);
    EXPECT_EQ(imageOverlap({0, 0, 10, 10}, {20, 0, 30, 10}), 0);
}

TEST(Overlap, ofRandomBoxesIsTheShareOfRandomPoints) {
    djpete_test::Random random(5);
    for (int round = 0; round < 10; ++round) {
        const UprightBox a{{0, 0, 0}, random.uniform(-3, 3), {4, 2, 1}};
        const UprightBox b{{random.uniform(-2, 2), random.uniform(-1, 1), 0},
                           random.uniform(-3, 3),
                           {random.uniform(2, 5), random.uniform(1, 3), 1}};
        const auto inside = [](const UprightBox& box, const Vec3& p) {
            const Vec3 q = SE3::fromYaw(box.yaw_rad, box.centre).inverse() * p;
            return std::abs(q.x()) <= box.size_m.x() / 2 && std::abs(q.y()) <= box.size_m.y() / 2;
        };
        double both = 0, either = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p(random.uniform(-6, 6), random.uniform(-6, 6), 0);
            const bool inA = inside(a, p), inB = inside(b, p);
            both += inA && inB ? 1 : 0;
            either += inA || inB ? 1 : 0;
        }
        EXPECT_NEAR(birdsEyeOverlap(a, b), both / either, 0.03);
    }
}

}  // namespace
}  // namespace djpete::obs
