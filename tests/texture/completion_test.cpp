#include "djpete/texture/completion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "made_car.h"

namespace {

using namespace djpete::texture;
using djpete_test::MadeCar;
using djpete_test::Vec3;

constexpr double kDegree = M_PI / 180;

Vec3 pointOf(const ObjectModel& m, std::size_t i) {
    const auto p = m.point(i);
    return {p[0], p[1], p[2]};
}

/// Seen from the left, the front and above, and a little of the right side's front.
bool seenFromFrontLeft(const Vec3& p, const Vec3& n) {
    return n.y() > 0.5 || n.x() > 0.5 || n.z() > 0.5 || (n.y() < -0.5 && p.x() > 1.2);
}

TEST(SymmetryFit, FindsAKnownPlane) {
    MadeCar car;
    car.offset_m = 0.05;
    car.yaw_rad = -1.3 * kDegree;
    car.seen = seenFromFrontLeft;
    const SymmetryFit fit = fitSymmetry(car.model());
    EXPECT_TRUE(fit.refined);
    EXPECT_NEAR(fit.plane.offset_m, 0.05, 0.01);
    EXPECT_NEAR(fit.plane.yaw_rad, -1.3 * kDegree, 0.4 * kDegree);
    ASSERT_TRUE(fit.distance_m && fit.box_distance_m);
    EXPECT_LT(*fit.distance_m, 0.015);
    // Twice the plane's offset at x = 1.65, the middle of what was seen of both sides.
    EXPECT_NEAR(*fit.box_distance_m, 2 * (0.05 - 1.65 * std::sin(1.3 * kDegree)), 0.01);
}

TEST(SymmetryFit, StaysWithTheBoxIfOnlyOneSideWasSeen) {
    MadeCar car;
    car.offset_m = 0.1;
    car.seen = [](const Vec3&, const Vec3& n) { return n.y() > 0.5 || n.x() < -0.5; };
    const SymmetryFit fit = fitSymmetry(car.model());
    EXPECT_FALSE(fit.refined);
    EXPECT_EQ(fit.plane.offset_m, 0);
    EXPECT_EQ(fit.plane.yaw_rad, 0);
    EXPECT_LT(fit.overlap, 0.05);
}

TEST(SymmetryFit, RefusesAPlaneFarFromTheBox) {
    MadeCar car;
    car.offset_m = 0.4;
    const SymmetryFit fit = fitSymmetry(car.model());
    EXPECT_FALSE(fit.refined);
    EXPECT_EQ(fit.plane.offset_m, 0);
}

TEST(Symmetrise, GivesTheUnseenHalfItsColours) {
    MadeCar car;
    car.seen = seenFromFrontLeft;
    ObjectModel model = car.model();
    const std::size_t seen = model.size();
    const ObjectModel shared = model;
    const SymmetryReport report = symmetrise(model);
    EXPECT_EQ(shared.cloud->size(), seen);  // copies keep what they had
    EXPECT_EQ(model.size(), seen + report.added);
    EXPECT_EQ(report.contradicted, 0U);
    // Of the right side all but the strip near its seen part is new.
    std::size_t right = 0;
    for (std::size_t i = seen; i < model.size(); ++i) {
        const Vec3 p = pointOf(model, i);
        EXPECT_EQ(model.flags[i], flag::kInferredPoint | flag::kInferredColour);
        EXPECT_EQ(model.seenIn[i], 0U);
        ASSERT_EQ(model.colours[i].count, 1U);
        const Vec3 n(model.normals[i][0], model.normals[i][1], model.normals[i][2]);
        if (n.y() > -0.9) continue;
        ++right;
        EXPECT_EQ(model.colours[i].mean, car.colourAt(p, n)) << p.transpose();
    }
    EXPECT_GT(right, 800U);
    for (std::size_t i = 0; i < seen; ++i) EXPECT_EQ(model.flags[i], 0);
}

TEST(Symmetrise, DoesNothingToAWholeCar) {
    ObjectModel model = MadeCar().model();
    const SymmetryReport report = symmetrise(model);
    EXPECT_EQ(report.added, 0U);
    EXPECT_EQ(report.coloured, 0U);
    EXPECT_TRUE(report.fit.refined);
}

/// A board that stands out on the left only; rays passed where its mirror image would be.
TEST(Symmetrise, BelievesTheRays) {
    MadeCar car;
    ObjectModel model = car.model();
    const auto addBoard = [](ObjectModel& m) {
        for (double x = 0.2; x < 1.0; x += 0.04) {
            for (double y = 0.3; y < 0.9; y += 0.04) {
                m.addPoint({static_cast<float>(x + 0.5), static_cast<float>(y), 0.6F}, {0, 0, 1},
                           0.04F);
                m.colours.back().add({1, 2, 250}, 1);
            }
        }
    };
    addBoard(model);
    ObjectModel believed = model;
    const std::size_t board = symmetrise(believed).added;
    EXPECT_GT(board, 200U);
    model.freeSpace.reset(model.size_m);
    for (double x = 0.5; x < 1.8; x += 0.03) {
        for (double y = -1.1; y < -0.1; y += 0.03) {
            model.freeSpace.addRay({x, y, 3}, {x, y, 0.05});
        }
    }
    ObjectModel doubted = model;
    const SymmetryReport report = symmetrise(doubted);
    EXPECT_EQ(report.added, 0U);
    EXPECT_EQ(report.contradicted, board);
}

/// Rays that graze the unseen side pass cells that its surface cuts: no contradiction.
TEST(Symmetrise, RaysAlongASurfaceAreNoContradiction) {
    MadeCar car;
    car.size_m.y() = 1.7;  // cells reach from -0.9 to -0.75 there
    car.seen = [](const Vec3&, const Vec3& n) { return n.y() > -0.5; };
    ObjectModel model = car.model();
    model.freeSpace.reset(model.size_m);
    for (double z = -0.7; z < 0.0; z += 0.03) {
        for (const double y : {-0.86, -0.87, -0.88}) {
            model.freeSpace.addRay({-6, y, z}, {6, y, z});
        }
    }
    ASSERT_TRUE(model.freeSpace.isFree({0, -0.85, -0.4}));
    const SymmetryReport report = symmetrise(model);
    EXPECT_EQ(report.contradicted, 0U);
    EXPECT_GT(report.added, 1000U);
}

TEST(Symmetrise, LeavesOutWhatIsBeyondTheBox) {
    ObjectModel model = MadeCar().model();
    for (double x = 0; x < 0.5; x += 0.04) {
        model.addPoint({static_cast<float>(x), 1.4F, 0}, {0, 1, 0}, 0.04F);
    }
    const SymmetryReport report = symmetrise(model);
    EXPECT_EQ(report.added, 0U);
    EXPECT_EQ(report.outside, 13U);
}

TEST(Symmetrise, PointsWithoutColourTakeTheirPartners) {
    MadeCar car;
    car.keepUnseen = true;
    car.seen = [](const Vec3&, const Vec3& n) { return n.y() > -0.5; };
    ObjectModel model = car.model();
    const SymmetryReport report = symmetrise(model);
    EXPECT_EQ(report.added, 0U);
    std::size_t right = 0, good = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (model.normals[i][1] > -0.9F) continue;
        ++right;
        EXPECT_EQ(model.flags[i], flag::kInferredColour);
        const auto want = car.colourAt(pointOf(model, i), {0, -1, 0});
        good += std::abs(model.colours[i].mean[1] - want[1]) < 20 ? 1U : 0U;
    }
    EXPECT_EQ(report.coloured, right);
    EXPECT_GT(static_cast<double>(good), 0.85 * static_cast<double>(right));  // but at edges
}

TEST(FillColours, GoesOverSmoothlyBetweenKnownColours) {
    // A strip, black at one end and light at the other; the middle is filled linearly.
    ObjectModel model;
    for (int i = 0; i <= 40; ++i) {
        for (int j = 0; j < 5; ++j) {
            model.addPoint({0.04F * static_cast<float>(i), 0.04F * static_cast<float>(j), 0},
                           {0, 0, 1}, 0.04F);
            if (i > 0 && i < 40) continue;
            const auto v = static_cast<float>(5 * i);
            model.colours.back().add({v, v, v}, 1);
        }
    }
    FillOptions options;
    options.sweeps = 3000;
    EXPECT_EQ(fillColours(model, options), 39U * 5U);
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto column = static_cast<float>(i / 5);
        EXPECT_NEAR(model.colours[i].mean[0], 5 * column, 12) << i;
        const bool known = column < 1 || column > 39;
        EXPECT_EQ(model.flags[i], known ? 0 : flag::kInferredColour);
        EXPECT_EQ(model.colours[i].count, 1U);
    }
}

/// Two sides of a car that do not touch: only a patch of the left one has a colour.
TEST(FillColours, BothSidesOfAnObjectLookTheSame) {
    ObjectModel model;
    for (const float side : {1.0F, -1.0F}) {
        for (int i = 0; i < 30; ++i) {
            for (int j = 0; j < 10; ++j) {
                model.addPoint({0.05F * static_cast<float>(i), side, 0.05F * static_cast<float>(j)},
                               {0, side, 0}, 0.04F);
                if (side < 0 || (i > 3 && i < 26)) continue;
                const float level = i < 10 ? 200.0F : 40.0F;
                model.colours.back().add({level, 50, 50}, 1);
            }
        }
    }
    // Dark ground nearer to the right side than the left side's paint.
    model.addPoint({0.7F, -0.7F, 0}, {0, 0, 1}, 0.04F);
    model.colours.back().add({0, 0, 0}, 1);
    EXPECT_EQ(fillColours(model), 220U + 300U);
    for (std::size_t i = 0; i < 300; ++i) {
        EXPECT_NEAR(model.colours[300 + i].mean[0], model.colours[i].mean[0], 25) << i;
        EXPECT_GT(model.colours[300 + i].mean[0], 30) << i;
    }
}

TEST(FillColours, ReachesIslandsButNotWhatIsFar) {
    ObjectModel model;
    model.addPoint({0, 0, 0}, {0, 0, 1}, 0.04F);
    model.colours[0].add({10, 20, 30}, 1);
    model.addPoint({0.5F, 0, 0}, {0, 0, 1}, 0.04F);
    model.addPoint({0.55F, 0, 0}, {0, 0, 1}, 0.04F);
    model.addPoint({5, 0, 0}, {0, 0, 1}, 0.04F);
    EXPECT_EQ(fillColours(model), 2U);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(model.colours[2].mean[c], model.colours[0].mean[c], 1e-3);
    }
    EXPECT_EQ(model.colours[3].count, 0U);
    EXPECT_EQ(model.flags[3], 0);
    ObjectModel none;
    EXPECT_EQ(fillColours(none), 0U);
    EXPECT_EQ(symmetrise(none).added, 0U);
}

}  // namespace
