/// Cars of known paint under a sun and a sky of the test's own making.
#include "albedo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_car.h"

namespace {

using namespace djpete::texture;
using djpete::geometry::Mat3;
using djpete::geometry::Vec3;
using djpete_test::MadeCar;

constexpr double kGamma = 1.2, kRoad = 0.15;
const Vec3 kSun = Vec3(std::cos(2.3) * 0.75, std::sin(2.3) * 0.75, 0.66).normalized();
const Light kSunlight{1.9, 1.75, 1.5}, kSkylight{0.38, 0.43, 0.52};

bool isPane(const Vec3& p, const Vec3& n) { return p.z() > 0 && n.z() < 0.5; }

/// Light from a surface with the world's normal; panes mirror an eighth of the sky.
Light lightFrom(const Light& albedo, const Vec3& n, bool sun, bool pane) {
    Light out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double arriving = kSkylight[c] * (0.75 + 0.25 * n.z()) +
                                (sun ? kSunlight[c] * std::max(0.0, n.dot(kSun)) : 0.0);
        out[c] = albedo[c] * arriving + (pane ? 0.13 : 0.03) * kSkylight[c];
    }
    return out;
}

std::array<float, 3> coded(const Light& light) {
    std::array<float, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = static_cast<float>(255 * std::pow(std::min(1.0, light[c]), 1 / kGamma));
    }
    return out;
}

struct World {
    std::vector<ObjectModel> cars;
    std::vector<Light> paints;
    std::vector<LitObject> lit;
    bool sun = true;

    void add(const Light& paint, double heading, bool inShade) {
        MadeCar made;
        made.step_m = 0.06;
        const Mat3 R = Eigen::AngleAxisd(heading, Vec3::UnitZ()).toRotationMatrix();
        ObjectModel car = made.model();
        for (std::size_t i = 0; i < car.size(); ++i) {
            const Vec3 n(car.normals[i][0], car.normals[i][1], car.normals[i][2]);
            const auto q = car.point(i);
            const bool pane = isPane(Vec3(q[0], q[1], q[2]), n);
            const Light light =
                lightFrom(pane ? Light{0.03, 0.03, 0.03} : paint, R * n, sun && !inShade, pane);
            car.colours[i] = ColourSum();
            car.colours[i].add(coded(light), 1);
            const auto face = static_cast<unsigned>(std::abs(car.normals[i][1]) > 0.5F) * 2U +
                              static_cast<unsigned>(n.dot(Vec3(1, 1, 0)) < 0);
            car.seenIn[i] = 1U << (n.z() > 0.5 ? 4U : face);
        }
        car.views = {{1}, {2}, {3}, {4}, {5}};
        GroundRing ring;
        for (std::size_t s = 0; s < kSectors; ++s) {
            const double azimuth = (static_cast<double>(s) + 0.5) * M_PI / 6;
            const bool ownShadow = Vec3(std::cos(azimuth), std::sin(azimuth), 0).dot(kSun) < -0.5;
            ring[s] = lightFrom({kRoad, kRoad, kRoad}, Vec3::UnitZ(), sun && !inShade && !ownShadow,
                                false);
        }
        cars.push_back(std::move(car));
        paints.push_back(paint);
        LitObject one;
        one.R_world_obj = R;
        one.cameras_obj = {{9, 0, 1}, {-9, 0, 1}, {0, 9, 1}, {0, -9, 1}, {4, 0, 5}};
        one.ring = ring;
        lit.push_back(one);
    }

    void addSome() {
        add({0.30, 0.30, 0.31}, 0.2, false);
        add({0.35, 0.05, 0.04}, 1.7, false);
        add({0.30, 0.30, 0.31}, 0.4, true);
        add({0.10, 0.14, 0.22}, 3.0, false);
        add({0.60, 0.60, 0.58}, 4.4, false);
        add({0.20, 0.22, 0.20}, 5.1, true);
    }

    void estimate(unsigned threads = 1) {
        for (std::size_t k = 0; k < cars.size(); ++k) lit[k].model = &cars[k];
        estimateAlbedos(lit, kGamma, threads);
    }
};

double linear(uint8_t coded) {
    const double v = coded / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// Medians over the painted points of estimated / true albedo, by channel.
Light ratioOf(const ObjectModel& car, const Light& paint) {
    Light out{};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < car.size(); ++i) {
            const Vec3 n(car.normals[i][0], car.normals[i][1], car.normals[i][2]);
            const auto q = car.point(i);
            if (isPane(Vec3(q[0], q[1], q[2]), n)) continue;
            ratios.push_back(linear(car.albedo[i][c]) / paint[c]);
        }
        std::sort(ratios.begin(), ratios.end());
        out[c] = ratios[ratios.size() / 2];
    }
    return out;
}

TEST(Albedo, PaintIsFoundInSunAndShade) {
    World world;
    world.addSome();
    world.estimate();
    // One factor is free: how much the road reflects.
    const double common = ratioOf(world.cars[0], world.paints[0])[1];
    EXPECT_GT(common, 0.6);
    EXPECT_LT(common, 1.3);
    for (std::size_t k = 0; k < world.cars.size(); ++k) {
        const Light ratio = ratioOf(world.cars[k], world.paints[k]);
        for (std::size_t c = 0; c < 3; ++c) {
            if (world.paints[k][c] < 0.06) continue;  // what is mirrored decides there
            EXPECT_NEAR(ratio[c] / common, 1, 0.3) << "car " << k << ", channel " << c;
        }
    }
    // The same paint in sun and in shade: images differ by a factor of 4.
    const Light sunny = ratioOf(world.cars[0], world.paints[0]),
                shady = ratioOf(world.cars[2], world.paints[2]);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shady[c] / sunny[c], 1, 0.15);
}

TEST(Albedo, PanesAreDarkWhateverTheyMirror) {
    World world;
    world.addSome();
    world.estimate();
    for (const std::size_t k : {0U, 1U, 4U}) {  // in the sun
        std::size_t panes = 0, found = 0, paint = 0, wrong = 0;
        const ObjectModel& car = world.cars[k];
        for (std::size_t i = 0; i < car.size(); ++i) {
            const Vec3 n(car.normals[i][0], car.normals[i][1], car.normals[i][2]);
            const auto q = car.point(i);
            const bool dark = (car.flags[i] & flag::kDarkPart) != 0;
            if (isPane(Vec3(q[0], q[1], q[2]), n)) {
                ++panes;
                found += dark ? 1 : 0;
            } else {
                ++paint;
                wrong += dark ? 1 : 0;
            }
        }
        EXPECT_GT(found, 0.7 * static_cast<double>(panes)) << "car " << k;
        EXPECT_LT(wrong, 0.1 * static_cast<double>(paint)) << "car " << k;
    }
}

TEST(Albedo, UnderCloudsToo) {
    World world;
    world.sun = false;
    world.addSome();
    world.estimate();
    const double common = ratioOf(world.cars[0], world.paints[0])[1];
    for (std::size_t k = 0; k < world.cars.size(); ++k) {
        EXPECT_NEAR(ratioOf(world.cars[k], world.paints[k])[1] / common, 1, 0.3) << "car " << k;
    }
}

TEST(Albedo, SameForAnyNumberOfThreads) {
    World one, three;
    one.addSome();
    three.addSome();
    one.estimate(1);
    three.estimate(3);
    for (std::size_t k = 0; k < one.cars.size(); ++k) {
        EXPECT_EQ(one.cars[k].albedo, three.cars[k].albedo);
        EXPECT_EQ(one.cars[k].flags, three.cars[k].flags);
    }
}

TEST(Albedo, WithoutGroundNothingIsClaimed) {
    World world;
    world.addSome();
    for (auto& object : world.lit) object.ring = GroundRing();
    world.estimate();
    for (const auto& car : world.cars) EXPECT_TRUE(car.albedo.empty());
}

TEST(Albedo, ACopyShowsItAndSubsetsKeepIt) {
    World world;
    world.addSome();
    world.estimate();
    const ObjectModel& car = world.cars[1];
    const ObjectModel shown = car.withAlbedo();
    for (std::size_t i = 0; i < car.size(); i += 97) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(shown.colours[i].mean[c], static_cast<float>(car.albedo[i][c]));
        }
        EXPECT_EQ(shown.colours[i].count, car.colours[i].count);
    }
    std::vector<bool> keep(car.size(), false);
    keep[5] = keep[car.size() - 1] = true;
    const ObjectModel part = car.subset(keep);
    ASSERT_EQ(part.albedo.size(), 2U);
    EXPECT_EQ(part.albedo[0], car.albedo[5]);
    EXPECT_EQ(part.albedo[1], car.albedo.back());
}

}  // namespace
