/// What becomes of the views that are kept: exposures, robust colours, textures that follow poses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "box_world.h"
#include "djpete/texture/object_texturer.h"

namespace {

using namespace djpete_test;
using djpete::map::ObjectId;
using djpete::obs::FrameId;
using djpete::texture::ObjectInView;
using djpete::texture::ObjectModel;
using djpete::texture::ObjectTexturer;
using djpete::texture::TextureOptions;
using djpete::texture::TextureView;

const ObjectId kCar{7};
const Vec3 kSize(4, 1.8, 1.5), kMiddle(0, 0, 0.75);
const std::array<Rgb, 6> kFaces{
    {{180, 40, 40}, {40, 170, 50}, {50, 70, 180}, {170, 150, 50}, {160, 160, 160}, {30, 30, 30}}};

BoxWorld street(double speckle_m = 0) {
    return {{{SE3::fromYaw(0, kMiddle), kSize, kFaces, speckle_m}}, Rgb{90, 90, 90}};
}

TextureView viewFrom(const BoxWorld& world, const Vec3& eye, uint64_t frame,
                     double brightness = 1) {
    TextureView view;
    view.frame = FrameId{frame};
    view.images.camera.model = smallCamera();
    view.T_world_cam = lookAt(eye, kMiddle);
    view.images.left = world.image(view.images.camera.model, view.T_world_cam, brightness);
    view.T_world_vehicle = SE3::fromYaw(0.3, eye + Vec3(0.05, 0.05, 0.1));
    view.scan = world.scan(view.T_world_vehicle);
    ObjectInView car;
    car.id = kCar;
    car.size_m = kSize;
    car.T_world_obj = world.boxes[0].T_world_box;
    view.objects.push_back(car);
    return view;
}

/// Mean distance of the coloured points, away from edges, from their face's colour times `scale`.
double meanError(const ObjectModel& model, double scale = 1) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto p = model.point(i);
        const OnFace on = nearestFace(Vec3(p[0], p[1], p[2]), kSize);
        if (model.colours[i].count == 0 || on.toEdge_m < 0.15) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            sum += std::abs(static_cast<double>(model.colours[i].mean[c]) -
                            scale * kFaces[static_cast<std::size_t>(on.face)][c]);
        }
        count += 3;
    }
    return sum / static_cast<double>(count);
}

double meanDeviation(const ObjectModel& model) {
    double sum = 0;
    std::size_t count = 0;
    for (const auto& colour : model.colours) {
        if (colour.count < 2) continue;
        sum += static_cast<double>(colour.standardDeviation());
        ++count;
    }
    return count == 0 ? 0 : sum / static_cast<double>(count);
}

std::string bytesOf(const ObjectModel& model) {
    std::string out;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto p = model.point(i);
        out.append(reinterpret_cast<const char*>(p.data()), sizeof(p));
        out.append(reinterpret_cast<const char*>(model.colours[i].mean.data()), 12);
        out.append(reinterpret_cast<const char*>(&model.seenIn[i]), 4);
    }
    return out;
}

const std::array<Vec3, 5> kEyes{
    {{6, -7, 2.5}, {4, -7, 2.5}, {2, -7, 2.5}, {0, -7, 2.5}, {-2, -7, 2.5}}};
const std::array<double, 5> kBrightness{1.0, 1.2, 0.8, 1.1, 0.7};

TEST(Exposures, AreEvenedOutWhenAsked) {
    const BoxWorld world = street();
    std::array<double, 2> deviation{};
    for (const bool exposure : {false, true}) {
        TextureOptions options;
        options.exposure = exposure;
        ObjectTexturer texturer(options);
        for (uint64_t k = 0; k < kEyes.size(); ++k) {
            texturer.addView(viewFrom(world, kEyes[k], k, kBrightness[k]));
        }
        texturer.settle();
        deviation[exposure ? 1 : 0] = meanDeviation(texturer.models().at(kCar));
        if (!exposure) {
            EXPECT_TRUE(texturer.exposures().empty());
            continue;
        }
        // Gains are those of the images, up to one factor: their geometric mean is 1.
        double logs = 0;
        for (const double b : kBrightness) logs += std::log(b) / kBrightness.size();
        for (uint64_t k = 0; k < kEyes.size(); ++k) {
            EXPECT_NEAR(texturer.exposures().at(FrameId{k}).gain, kBrightness[k] / std::exp(logs),
                        0.04);
        }
        EXPECT_LT(meanError(texturer.models().at(kCar), std::exp(logs)), 4);
    }
    EXPECT_GT(deviation[0], 8);
    EXPECT_LT(deviation[1], 0.2 * deviation[0]);
}

TEST(RobustColours, AHighlightInOneOfFiveViewsDoesNotShow) {
    const BoxWorld world = street();
    BoxWorld dazzling = street();
    for (auto& face : dazzling.boxes[0].faces) face = {255, 255, 255};
    TextureOptions options;
    options.exposure = false;
    ObjectTexturer texturer(options);
    for (uint64_t k = 0; k < kEyes.size(); ++k) {
        texturer.addView(viewFrom(k == 2 ? dazzling : world, kEyes[k], k));
    }
    const ObjectModel& model = texturer.models().at(kCar);
    EXPECT_LT(meanError(model), 1.5);
    std::size_t agreed = 0, dazzled = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        agreed += model.colours[i].count == 4 ? 1 : 0;
        dazzled += model.colours[i].count >= 3 && (model.seenIn[i] >> 2U & 1U) != 0 ? 1 : 0;
    }
    EXPECT_GT(agreed, 500U);
    EXPECT_LT(dazzled, model.size() / 50);
}

TEST(Follow, PointsAndColoursGoWithCorrectedPoses) {
    const BoxWorld world = street(0.3);
    const auto wrongBy = [](uint64_t k) {
        return SE3::fromYaw(k == 0 ? 0.0 : 0.05, Vec3(0.25 * static_cast<double>(k), 0.1, 0));
    };
    TextureOptions options;
    options.refine = false;  // it rounds the box's edges
    ObjectTexturer right(options), wrong(options);
    for (uint64_t k = 0; k < 3; ++k) {
        auto view = viewFrom(world, kEyes[k], k);
        right.addView(view);
        view.objects[0].T_world_obj = view.objects[0].T_world_obj * wrongBy(k);
        wrong.addView(view);
    }
    const auto poseOf = [&](FrameId frame) -> std::optional<SE3> {
        return lookAt(kEyes[frame.value], kMiddle).inverse() * world.boxes[0].T_world_box;
    };
    right.settle();
    EXPECT_FALSE(right.follow(kCar, poseOf));
    const double before = meanDeviation(wrong.models().at(kCar));
    EXPECT_TRUE(wrong.follow(kCar, poseOf));
    EXPECT_FALSE(wrong.follow(kCar, poseOf));
    wrong.settle();
    const ObjectModel &good = right.models().at(kCar), &mended = wrong.models().at(kCar);
    EXPECT_LT(meanDeviation(mended), 0.6 * before);
    EXPECT_NEAR(meanDeviation(mended), meanDeviation(good), 0.15 * meanDeviation(good) + 0.5);
    for (std::size_t i = 0; i < mended.size(); ++i) {
        const auto p = mended.point(i);
        const Vec3 outside = Vec3(p[0], p[1], p[2]).cwiseAbs() - 0.5 * kSize;
        EXPECT_LT(std::abs(outside.maxCoeff()), 0.02) << i;
    }
    EXPECT_FALSE(right.follow(ObjectId{99}, poseOf));  // nobody
}

TEST(Settle, LatePointsTakeColoursFromEarlyViews) {
    const BoxWorld world = street();
    ObjectTexturer texturer;
    for (uint64_t k = 0; k < 2; ++k) {
        auto view = viewFrom(world, kEyes[k], k);
        // First only a few points; the rest when the camera sees another side.
        if (k == 0) {
            auto& points = view.scan->points;
            std::size_t kept = 0;
            for (std::size_t i = 0; i < points.size(); i += 10) points[kept++] = points[i];
            points.resize(kept);
        } else {
            view.T_world_cam = lookAt({-7, 6, 2.5}, kMiddle);
            view.images.left = world.image(view.images.camera.model, view.T_world_cam);
        }
        texturer.addView(view);
    }
    const double before = texturer.models().at(kCar).coverage();
    texturer.settle();
    const ObjectModel& model = texturer.models().at(kCar);
    EXPECT_LT(before, 0.5);
    EXPECT_GT(model.coverage(), 0.8);
    EXPECT_LT(meanError(model), 4);
}

TEST(Settle, GivesTheSameBytesForAnyNumberOfThreads) {
    const BoxWorld world = street(0.1);
    const auto run = [&](unsigned threads) {
        ObjectTexturer texturer;
        for (uint64_t k = 0; k < kEyes.size(); ++k) {
            auto view = viewFrom(world, kEyes[k], k, kBrightness[k]);
            for (uint64_t other = 0; other < 3; ++other) {
                view.objects[0].id = ObjectId{other};
                texturer.addView(view);
            }
        }
        texturer.settle(threads);
        std::string bytes;
        for (const auto& [id, model] : texturer.models()) bytes += bytesOf(model);
        return bytes;
    };
    const std::string one = run(1);
    EXPECT_GT(one.size(), 10000U);
    EXPECT_EQ(one, run(3));
}

TEST(Refine, TakesNoiseOutAndFillsGaps) {
    const BoxWorld world = street();
    std::array<double, 2> off{};
    std::array<std::size_t, 2> size{};
    for (const bool refine : {false, true}) {
        TextureOptions options;
        options.refine = refine;
        ObjectTexturer texturer(options);
        std::mt19937_64 random(7);
        for (uint64_t k = 0; k < 3; ++k) {
            auto view = viewFrom(world, kEyes[k], k);
            for (auto& p : view.scan->points) {
                const auto stretch =
                    static_cast<float>(static_cast<double>(random() % 1000) / 1e3 - 0.5) *
                    0.008F;  // some 3 cm at 7 m
                p.x *= 1 + stretch;
                p.y *= 1 + stretch;
                p.z *= 1 + stretch;
            }
            texturer.addView(view);
        }
        texturer.settle();
        const ObjectModel& model = texturer.models().at(kCar);
        std::size_t count = 0;
        for (std::size_t i = 0; i < model.size(); ++i) {
            const auto p = model.point(i);
            const Vec3 at(p[0], p[1], p[2]);
            if (nearestFace(at, kSize).toEdge_m < 0.15) continue;
            off[refine ? 1 : 0] += std::abs((at.cwiseAbs() - 0.5 * kSize).maxCoeff());
            ++count;
        }
        off[refine ? 1 : 0] /= static_cast<double>(count);
        size[refine ? 1 : 0] = model.size();
        EXPECT_LT(meanError(model), 5);
    }
    EXPECT_LT(off[1], 0.75 * off[0]);
    EXPECT_GT(size[1], size[0]);
}

TEST(Refine, PointsThatMasksContradictGo) {
    const BoxWorld world = street();
    ObjectTexturer texturer;
    for (uint64_t k = 0; k < 3; ++k) {
        auto view = viewFrom(world, kEyes[k], k);
        // The box is too high, and something in the upper part of it is not the car.
        view.objects[0].size_m = kSize + Vec3(0, 0, 1);
        const SE3 T_velo_world = (view.T_world_vehicle * view.scan->T_vehicle_velo).inverse();
        for (int n = 0; n < 40; ++n) {
            const Vec3 p = T_velo_world * Vec3(0.04 * n - 0.8, 0.3, 1.85);
            view.scan->points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                         static_cast<float>(p.z()), 0.5F});
        }
        if (k > 0) {  // first without a mask, which would have kept the points away
            view.objects[0].mask = world.mask(0, view.images.camera.model, view.T_world_cam);
        }
        texturer.addView(view);
    }
    const auto above = [&] {
        std::size_t count = 0;
        const ObjectModel& model = texturer.models().at(kCar);
        for (std::size_t i = 0; i < model.size(); ++i) count += model.point(i)[2] > 1 ? 1U : 0U;
        return count;
    };
    EXPECT_GT(above(), 10U);
    const std::size_t before = texturer.models().at(kCar).size();
    texturer.settle();
    EXPECT_EQ(above(), 0U);
    EXPECT_GT(texturer.models().at(kCar).size(), before / 2);
}

TEST(Exposures, ComeFromTheSceneWhereTheCarGleams) {
    // The car is brighter in every view, the street is not: that is no exposure.
    ObjectTexturer texturer;
    for (uint64_t k = 0; k < kEyes.size(); ++k) {
        BoxWorld gleaming = street();
        for (auto& face : gleaming.boxes[0].faces) {
            for (auto& c : face) c = static_cast<uint8_t>(c * (1 + 0.1 * static_cast<double>(k)));
        }
        texturer.addView(viewFrom(gleaming, kEyes[k], k));
    }
    texturer.settle();
    for (const auto& [frame, exposure] : texturer.exposures()) {
        EXPECT_NEAR(exposure.gain, 1, 0.04) << frame.value;
    }
}

TEST(Exposures, DoNotFallBecauseCornersAreDark) {
    // Ahead along the street: all that comes nearer moves outwards in the image.
    const BoxWorld world = street();
    constexpr double kLostInCorners = 0.2;
    ObjectTexturer texturer;
    for (uint64_t k = 0; k < 16; ++k) {
        const Vec3 eye(-24 + static_cast<double>(k), -2.5, 1.7);
        TextureView view = viewFrom(world, eye, k);
        view.T_world_cam = lookAt(eye, eye + Vec3(10, 0, -0.5));
        const auto& camera = view.images.camera.model;
        view.images.left = world.image(camera, view.T_world_cam);
        const Vec2 centre(camera.cx, camera.cy);
        const double corner2 = centre.squaredNorm();
        for (int y = 0; y < camera.height_px; ++y) {
            auto* row = view.images.left.ptrLine<uint8_t>(static_cast<unsigned>(y));
            for (int x = 0; x < camera.width_px; ++x) {
                const double light =
                    1 - kLostInCorners * (Vec2(x, y) - centre).squaredNorm() / corner2;
                for (int c = 0; c < 3; ++c, ++row)
                    *row = static_cast<uint8_t>(std::lround(light * *row));
            }
        }
        texturer.addView(view);
    }
    texturer.settle();
    ASSERT_EQ(texturer.exposures().size(), 16U);
    for (const auto& [frame, exposure] : texturer.exposures()) {
        EXPECT_NEAR(exposure.gain, 1, 0.015) << frame.value;
    }
}

TEST(KeptViews, AreTheBestAndWithinMemory) {
    const BoxWorld world = street();
    TextureOptions options;
    options.max_views_per_object = 3;
    ObjectTexturer texturer(options);
    // The far view adds least.
    texturer.addView(viewFrom(world, {6, -30, 2.5}, 0));
    for (uint64_t k = 0; k < 3; ++k) texturer.addView(viewFrom(world, kEyes[k], k + 1));
    EXPECT_THAT(texturer.models().at(kCar).views,
                testing::ElementsAre(FrameId{1}, FrameId{2}, FrameId{3}));
    for (const uint32_t seen : texturer.models().at(kCar).seenIn) EXPECT_LT(seen, 8U);

    options.max_views_per_object = 16;
    options.max_view_mb = 0;
    ObjectTexturer poor(options);
    for (uint64_t k = 0; k < kEyes.size(); ++k) poor.addView(viewFrom(world, kEyes[k], k));
    EXPECT_EQ(poor.models().at(kCar).views.size(), 1U);
    EXPECT_GT(poor.models().at(kCar).coverage(), 0.3);
}

}  // namespace
