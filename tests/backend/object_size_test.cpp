#include "djpete/backend/object_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "djpete_test/random.h"

namespace djpete::backend {
namespace {

using geometry::Vec3;
using obs::ObjectClass;

/// Much longer and higher than a car usually is.
const Vec3 kLong(5.2, 1.9, 1.9);

std::vector<SeenSize> seen(int n, double sigma, uint64_t seed) {
    djpete_test::Random random(seed);
    std::vector<SeenSize> out;
    for (int i = 0; i < n; ++i) {
        SeenSize s{kLong, sigma};
        for (int axis = 0; axis < 3; ++axis) s.size_m[axis] *= std::exp(random.normal(sigma));
        out.push_back(s);
    }
    return out;
}

/// 0: as the class usually is; 1: as seen. Of the length.
double share(const Vec3& size_m, ObjectClass objectClass = ObjectClass::Car) {
    const double usual = std::log(usualSize(objectClass).mean_m.x());
    return (std::log(size_m.x()) - usual) / (std::log(kLong.x()) - usual);
}

TEST(ObjectSize, oneDetectionIsPulledToWhatIsUsual) {
    const Vec3 size_m = estimateSize({{kLong, 0.1}}, ObjectClass::Car, 1);
    const Vec3 usual = usualSize(ObjectClass::Car).mean_m;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(size_m[axis], usual[axis]);
        EXPECT_LT(size_m[axis], kLong[axis]);
    }
    EXPECT_LT(share(size_m), 0.7);
}

TEST(ObjectSize, manyDetectionsWin) {
    const double few = share(estimateSize(seen(3, 0.08, 1), ObjectClass::Car, 1));
    const double many = share(estimateSize(seen(500, 0.08, 1), ObjectClass::Car, 1));
    EXPECT_LT(few, 0.85);
    EXPECT_NEAR(many, 1, 0.04);
}

TEST(ObjectSize, aStrongerPriorPullsMoreAndNoneNotAtAll) {
    const auto sizes = seen(4, 0.08, 2);
    const double none = share(estimateSize(sizes, ObjectClass::Car, 0));
    const double one = share(estimateSize(sizes, ObjectClass::Car, 1));
    const double ten = share(estimateSize(sizes, ObjectClass::Car, 10));
    EXPECT_GT(none, one);
    EXPECT_GT(one, ten);
    EXPECT_LT(ten, 0.35);
    EXPECT_LT((estimateSize({{kLong, 0.1}}, ObjectClass::Car, 0) - kLong).norm(), 1e-12);
}

TEST(ObjectSize, alikeDetectionsAreTheirOwnMeanWithoutAPrior) {
    // ln: the mean of a and b is sqrt(a b), whichever way round.
    const std::vector<SeenSize> two{{{4, 2, 1}, 0.3}, {{5, 2, 1.2}, 0.3}};
    const Vec3 size_m = estimateSize(two, ObjectClass::Car, 0);
    EXPECT_NEAR(size_m.x(), std::sqrt(20.0), 1e-6);
    EXPECT_NEAR(size_m.y(), 2, 1e-9);
    EXPECT_NEAR(size_m.z(), std::sqrt(1.2), 1e-6);
}

TEST(ObjectSize, outliersDoNotPull) {
    auto sizes = seen(40, 0.05, 3);
    const Vec3 clean = estimateSize(sizes, ObjectClass::Car, 1);
    for (std::size_t i = 0; i < sizes.size(); i += 5) sizes[i].size_m *= 3;
    const Vec3 dirty = estimateSize(sizes, ObjectClass::Car, 1);
    // Least squares would be pulled by ln(3) / 5, to 1.25 of it.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(dirty[axis] / clean[axis], 1, 0.03);
}

TEST(ObjectSize, sureDetectionsCountMore) {
    const std::vector<SeenSize> two{{{4, 2, 1.5}, 0.02}, {{4.4, 2, 1.5}, 0.2}};
    const Vec3 size_m = estimateSize(two, ObjectClass::Car, 0);
    EXPECT_NEAR(size_m.x(), 4, 0.02);
}

TEST(ObjectSize, everyClassHasAUsualSize) {
    for (const auto c :
         {ObjectClass::Car, ObjectClass::Van, ObjectClass::Truck, ObjectClass::Pedestrian,
          ObjectClass::Cyclist, ObjectClass::Tram, ObjectClass::Other}) {
        const auto usual = usualSize(c);
        EXPECT_GT(usual.mean_m.minCoeff(), 0.3) << obs::toString(c);
        EXPECT_GT(usual.sigma_m.minCoeff(), 0.05) << obs::toString(c);
        const Vec3 size_m = estimateSize({{usual.mean_m, 0.1}}, c, 1);
        EXPECT_LT((size_m - usual.mean_m).norm(), 1e-9) << obs::toString(c);
    }
    // What can be of any size is believed as it is seen.
    EXPECT_NEAR(estimateSize({{{9, 2.5, 3}, 0.08}}, ObjectClass::Other, 1).x(), 9, 0.25);
}

}  // namespace
}  // namespace djpete::backend
