#include "djpete/texture/free_space.h"

#include <gtest/gtest.h>

namespace {

using djpete::geometry::Vec3;
using djpete::texture::FreeSpace;

FreeSpace carBox() {
    FreeSpace space;
    space.reset({4, 1.8, 1.5});
    return space;
}

TEST(FreeSpace, IsWhereRaysPassed) {
    FreeSpace space = carBox();
    const Vec3 sensor(10, 0.4, 0.3);
    for (int k = 0; k < 3; ++k) space.addRay(sensor, {-8, 0.4, 0.3});  // through and out again
    EXPECT_TRUE(space.isFree({1, 0.4, 0.3}));
    EXPECT_TRUE(space.isFree({-1.5, 0.4, 0.3}));
    EXPECT_FALSE(space.isFree({1, -0.4, 0.3}));
    EXPECT_FALSE(space.isFree({5, 0.4, 0.3}));  // outside the box nothing is known
}

TEST(FreeSpace, EndsBeforeTheSurface) {
    FreeSpace space = carBox();
    for (int k = 0; k < 9; ++k) space.addRay({10, 0, 0}, {1.0, 0, 0});
    EXPECT_TRUE(space.isFree({1.8, 0, 0}));
    EXPECT_FALSE(space.isFree({1.05, 0, 0}));
    EXPECT_FALSE(space.isFree({0.5, 0, 0}));
}

TEST(FreeSpace, OneRayIsNoProofAndManyEndsSpeakAgainstIt) {
    FreeSpace space = carBox();
    space.addRay({10, 0, 0}, {-8, 0, 0});
    EXPECT_FALSE(space.isFree({1, 0, 0}));
    for (int k = 0; k < 3; ++k) space.addRay({10, 0, 0}, {-8, 0, 0});
    EXPECT_TRUE(space.isFree({1, 0, 0}));
    for (int k = 0; k < 3; ++k) space.addRay({1, 8, 0}, {1, 0, 0});
    EXPECT_FALSE(space.isFree({1, 0, 0}));
}

TEST(FreeSpace, EmptyKnowsNothing) {
    FreeSpace space;
    space.addRay({10, 0, 0}, {-8, 0, 0});
    EXPECT_TRUE(space.empty());
    EXPECT_FALSE(space.isFree({1, 0, 0}));
}

}  // namespace
