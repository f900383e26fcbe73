#include "djpete/texture/object_texturer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "box_world.h"
#include "djpete/obs/errors.h"

namespace {

using namespace djpete_test;
using djpete::map::ObjectId;
using djpete::obs::FrameId;
using djpete::obs::InputError;
using djpete::texture::ObjectInView;
using djpete::texture::ObjectModel;
using djpete::texture::ObjectTexturer;
using djpete::texture::TextureOptions;
using djpete::texture::TextureView;

const ObjectId kCar{7}, kOther{3};
const std::array<Rgb, 6> kFaces{
    {{220, 30, 30}, {30, 200, 40}, {40, 60, 210}, {220, 200, 40}, {240, 240, 240}, {10, 10, 10}}};
const Vec3 kSize(4, 1.8, 1.5);
constexpr double kEdge_m = 0.12;  // nearer to an edge a pixel may show two faces

ColourBox carBox(const Vec3& centre = Vec3(0, 0, 0.75), double yaw = 0) {
    return {SE3::fromYaw(yaw, centre), kSize, kFaces, 0};
}

ObjectInView inView(ObjectId id, const ColourBox& box) {
    ObjectInView out;
    out.id = id;
    out.size_m = box.size_m;
    out.T_world_obj = box.T_world_box;
    return out;
}

/// The car (box 0) seen by a camera at `eye`, with a scan from just beside it.
TextureView viewFrom(const BoxWorld& world, const Vec3& eye, const Vec3& target, uint64_t frame,
                     double brightness = 1) {
    TextureView view;
    view.frame = FrameId{frame};
    view.images.camera.model = smallCamera();
    view.T_world_cam = lookAt(eye, target);
    view.images.left = world.image(view.images.camera.model, view.T_world_cam, brightness);
    view.T_world_vehicle = SE3::fromYaw(0.3, eye + Vec3(0.05, 0.05, 0.1));
    view.scan = world.scan(view.T_world_vehicle);
    view.objects.push_back(inView(kCar, world.boxes[0]));
    return view;
}

Vec3 pointOf(const ObjectModel& model, std::size_t i) {
    float x = 0, y = 0, z = 0;
    model.cloud->getPointFast(i, x, y, z);
    return {x, y, z};
}

struct Tally {
    std::size_t points = 0, coloured = 0, wrong = 0;
    std::array<std::size_t, 6> pointsOnFace{}, colouredOnFace{};
};

/// Compares every coloured point away from edges with the colour of its face.
Tally compare(const ObjectModel& model, const std::array<Rgb, 6>& faces, double tolerance = 2.5,
              double brightness = 1) {
    Tally tally;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const OnFace on = nearestFace(pointOf(model, i), model.size_m);
        if (on.toEdge_m < kEdge_m) continue;
        const auto face = static_cast<std::size_t>(on.face);
        ++tally.points;
        ++tally.pointsOnFace[face];
        if (model.colours[i].count == 0) continue;
        ++tally.coloured;
        ++tally.colouredOnFace[face];
        for (unsigned c = 0; c < 3; ++c) {
            const double apart =
                static_cast<double>(model.colours[i].mean[c]) - brightness * faces[face][c];
            if (std::abs(apart) > tolerance) {
                ++tally.wrong;
                break;
            }
        }
    }
    return tally;
}

TEST(ObjectTexturerOptions, AGammaThatNoCameraHasIsTold) {
    djpete::texture::TextureOptions options;
    options.camera_gamma = 0;
    EXPECT_THROW(djpete::texture::ObjectTexturer{options}, djpete::obs::InputError);
}

TEST(ObjectTexturer, GivesEveryPointTheColourOfItsFace) {
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    ObjectTexturer texturer;
    const auto report = texturer.addView(viewFrom(world, {7, -6, 3}, {0, 0, 0.75}, 0));
    const ObjectModel& model = texturer.models().at(kCar);
    const Tally tally = compare(model, kFaces);
    EXPECT_GT(tally.pointsOnFace[0], 100U);
    EXPECT_GT(tally.pointsOnFace[3], 300U);
    EXPECT_EQ(tally.wrong, 0U);
    EXPECT_GT(tally.colouredOnFace[0] + tally.colouredOnFace[3],
              95 * (tally.pointsOnFace[0] + tally.pointsOnFace[3]) / 100);
    EXPECT_EQ(report.pointsAdded, model.size());
    EXPECT_GT(model.coverage(), 0.8);
    EXPECT_THAT(model.views, testing::ElementsAre(FrameId{0}));
}

TEST(ObjectTexturer, CloudCarriesTheColoursAndGreyWhereThereIsNone) {
    const BoxWorld world{{carBox()}, std::nullopt};
    ObjectTexturer texturer;
    auto view = viewFrom(world, {7, -6, 3}, {0, 0, 0.75}, 0);
    view.T_world_vehicle = SE3::fromYaw(0, {-7, 6, 1.8});  // scanned from the other side
    view.scan = world.scan(view.T_world_vehicle);
    texturer.addView(view);
    view = viewFrom(world, {7, -6, 3}, {0, 0, 0.75}, 1);
    texturer.addView(view);
    const ObjectModel& model = texturer.models().at(kCar);
    std::size_t grey = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        float r = 0, g = 0, b = 0;
        model.cloud->getPointColor_fast(i, r, g, b);
        const auto& sum = model.colours[i];
        if (sum.count == 0) {
            ++grey;
            EXPECT_EQ(r, ObjectModel::kNeutralGrey);
            EXPECT_EQ(g, ObjectModel::kNeutralGrey);
            EXPECT_EQ(b, ObjectModel::kNeutralGrey);
        } else {
            EXPECT_FLOAT_EQ(r, sum.mean[0] / 255);
            EXPECT_FLOAT_EQ(b, sum.mean[2] / 255);
        }
    }
    EXPECT_GT(grey, 100U);
    EXPECT_LT(grey, model.size());
}

TEST(ObjectTexturer, LeavesTheBackSideAloneUntilItIsSeen) {
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    ObjectTexturer texturer;
    // The scan shows the far faces (-x, +y); the camera looks at the near ones (+x, -y).
    auto view = viewFrom(world, {7, -6, 1.2}, {0, 0, 0.75}, 0);
    view.T_world_vehicle = SE3::fromYaw(0, {-7, 6, 1.2});
    view.scan = world.scan(view.T_world_vehicle);
    texturer.addView(view);
    Tally tally = compare(texturer.models().at(kCar), kFaces);
    EXPECT_GT(tally.pointsOnFace[1] + tally.pointsOnFace[2], 400U);
    EXPECT_EQ(tally.coloured, 0U);
    // The near side too, still from the near side: the far side stays without colour.
    texturer.addView(viewFrom(world, {7, -6, 1.2}, {0, 0, 0.75}, 1));
    tally = compare(texturer.models().at(kCar), kFaces);
    EXPECT_EQ(tally.wrong, 0U);
    EXPECT_EQ(tally.colouredOnFace[1] + tally.colouredOnFace[2], 0U);
    EXPECT_GT(tally.colouredOnFace[0] + tally.colouredOnFace[3], 400U);
    // Now the camera goes round.
    texturer.addView(viewFrom(world, {-7, 6, 1.2}, {0, 0, 0.75}, 2));
    tally = compare(texturer.models().at(kCar), kFaces);
    EXPECT_EQ(tally.wrong, 0U);
    EXPECT_GT(tally.colouredOnFace[1] + tally.colouredOnFace[2],
              9 * (tally.pointsOnFace[1] + tally.pointsOnFace[2]) / 10);
}

TEST(ObjectTexturer, AnotherObjectInFrontDoesNotBleed) {
    // The image shows a magenta car in front of a part of ours.
    ColourBox front = carBox({4.2, -3.6, 0.75}, 0.6);
    front.faces = allFaces({255, 0, 255});
    const BoxWorld alone{{carBox()}, Rgb{90, 90, 90}};
    const BoxWorld both{{carBox(), front}, Rgb{90, 90, 90}};
    ObjectTexturer texturer, unhindered;
    auto first = viewFrom(alone, {7, -6, 3}, {0, 0, 0.75}, 0);
    first.images.left = both.image(first.images.camera.model, first.T_world_cam);
    first.objects.push_back(inView(kOther, front));
    texturer.addView(first);  // scene points know nothing of the front car, only its box does
    const Tally tally = compare(texturer.models().at(kCar), kFaces);
    EXPECT_EQ(tally.wrong, 0U);
    EXPECT_GT(tally.coloured, 300U);
    unhindered.addView(viewFrom(alone, {7, -6, 3}, {0, 0, 0.75}, 0));
    const Tally all = compare(unhindered.models().at(kCar), kFaces);
    EXPECT_EQ(all.points, tally.points);
    EXPECT_LT(tally.coloured, 8 * all.coloured / 10);
}

TEST(ObjectTexturer, ScenePointsInFrontDoNotBleed) {
    // A magenta wall hides half the car; nobody lists it as an object, but the scan sees it.
    ColourBox wall;
    wall.T_world_box = SE3::fromYaw(0, {1.5, -4.5, 1.5});
    wall.size_m = Vec3(3, 0.2, 3);
    wall.faces = allFaces({255, 0, 255});
    const BoxWorld alone{{carBox()}, Rgb{90, 90, 90}};
    const BoxWorld both{{carBox(), wall}, Rgb{90, 90, 90}};
    ObjectTexturer texturer;
    texturer.addView(viewFrom(alone, {0, -8, 3}, {0, 0, 0.75}, 0));
    const auto before = texturer.models().at(kCar).colours;
    texturer.addView(viewFrom(both, {0, -8, 3}, {0, 0, 0.75}, 1));
    const ObjectModel& model = texturer.models().at(kCar);
    const Tally tally = compare(model, kFaces);
    EXPECT_EQ(tally.wrong, 0U);
    std::size_t again = 0, hidden = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i].count == 0) continue;
        ++(model.colours[i].count > before[i].count ? again : hidden);
    }
    EXPECT_GT(again, 200U);
    EXPECT_GT(hidden, 200U);
}

TEST(ObjectTexturer, TakesNoColourOutsideTheMask) {
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    auto view = viewFrom(world, {0, -8, 3}, {0, 0, 0.75}, 0);
    const auto& camera = view.images.camera.model;
    std::vector<uint8_t> leftHalf(static_cast<std::size_t>(camera.width_px * camera.height_px), 0);
    for (int v = 0; v < camera.height_px; ++v) {
        for (int u = 0; u < camera.width_px / 2; ++u) {
            leftHalf[static_cast<std::size_t>(v * camera.width_px + u)] = 1;
        }
    }
    view.objects[0].mask = djpete::obs::RleMask::fromDense(leftHalf.data(), 400, 240, 400);
    ObjectTexturer texturer;
    texturer.addView(viewFrom(world, {0, -8, 3}, {0, 0, 0.75}, 0));  // all points, all colours
    const auto before = texturer.models().at(kCar).colours;
    view.frame = FrameId{1};
    texturer.addView(view);
    const ObjectModel& model = texturer.models().at(kCar);
    std::size_t inside = 0, outside = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 p_cam =
            view.T_world_cam.inverse() * (view.objects[0].T_world_obj * pointOf(model, i));
        const double u = camera.project(p_cam).x();
        const bool grew = model.colours[i].count > before[i].count;
        if (u > 200 - 2) {
            EXPECT_FALSE(grew) << "u = " << u;  // mask minus its eroded border
            ++outside;
        } else {
            inside += grew ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 300U);
    EXPECT_GT(outside, 300U);
}

TEST(ObjectTexturer, CountsViewsAndKeepsTheVariance) {
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    TextureOptions options;
    options.exposure = false;
    ObjectTexturer texturer(options);
    const Vec3 eye(0, -8, 1.7), target(0, 0, 0.75);
    texturer.addView(viewFrom(world, eye, target, 0, 1.0));
    texturer.addView(viewFrom(world, eye, target, 4, 0.8));
    const ObjectModel& model = texturer.models().at(kCar);
    EXPECT_THAT(model.views, testing::ElementsAre(FrameId{0}, FrameId{4}));
    std::size_t twice = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const OnFace on = nearestFace(pointOf(model, i), kSize);
        if (model.colours[i].count != 2 || on.face != 3 || on.toEdge_m < kEdge_m) continue;
        ++twice;
        // Same place, same weight: mean 0.9, deviation 0.1 of the colour.
        EXPECT_NEAR(model.colours[i].mean[0], 0.9 * kFaces[3][0], 1.0);
        EXPECT_NEAR(std::sqrt(model.colours[i].variance()[0]), 0.1 * kFaces[3][0], 1.0);
    }
    EXPECT_GT(twice, 300U);
}

TEST(ObjectTexturer, NearViewsWeighMore) {
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    TextureOptions options;
    options.exposure = false;
    ObjectTexturer texturer(options);
    texturer.addView(viewFrom(world, {0, -8, 1.2}, {0, 0, 0.75}, 0, 1.0));
    texturer.addView(viewFrom(world, {0, -25, 1.2}, {0, 0, 0.75}, 1, 0.5));
    const ObjectModel& model = texturer.models().at(kCar);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const OnFace on = nearestFace(pointOf(model, i), kSize);
        if (model.colours[i].count != 2 || on.face != 3 || on.toEdge_m < 0.15) continue;
        sum += static_cast<double>(model.colours[i].mean[0]);
        ++count;
    }
    ASSERT_GT(count, 100U);
    EXPECT_GT(sum / static_cast<double>(count), 0.85 * kFaces[3][0]);
}

TEST(ObjectTexturer, FollowsAMovingObject) {
    ObjectTexturer texturer;
    for (uint64_t frame = 0; frame < 4; ++frame) {
        const auto step = static_cast<double>(frame);
        const BoxWorld world{{carBox({0.8 * step, 0.1 * step, 0.75}, 0.1 * step)}, Rgb{90, 90, 90}};
        texturer.addView(viewFrom(world, {2, -8, 3}, {1, 0, 0.75}, frame));
    }
    const ObjectModel& model = texturer.models().at(kCar);
    const Tally tally = compare(model, kFaces);
    EXPECT_EQ(tally.wrong, 0U);
    EXPECT_GT(tally.colouredOnFace[3], 500U);
    for (std::size_t i = 0; i < model.size(); ++i) {
        // All four scans lie on the one surface.
        const Vec3 p = pointOf(model, i);
        EXPECT_LT(std::abs((p.cwiseAbs() - 0.5 * kSize).maxCoeff()), 1e-3);
    }
}

TEST(ObjectTexturer, WithoutAScanStereoGivesThePoints) {
    ColourBox car = carBox({8, 0, 0.75}, 0.5);
    car.speckle_m = 0.04;
    const BoxWorld world{{car}, Rgb{90, 90, 90}};
    TextureView view;
    view.frame = FrameId{0};
    auto& camera = view.images.camera.model;
    camera = smallCamera();
    camera.baseline_m = 0.4;
    view.T_world_cam = lookAt({0, 0, 1.5}, {8, 0, 1.0});
    view.images.left = world.image(camera, view.T_world_cam);
    view.images.right = world.image(
        camera, view.T_world_cam * SE3(djpete::geometry::Mat3::Identity(), Vec3(0.4, 0, 0)));
    view.objects.push_back(inView(kCar, car));
    ObjectTexturer texturer;
    texturer.addView(view);
    ASSERT_EQ(texturer.models().count(kCar), 1U);
    const ObjectModel& model = texturer.models().at(kCar);
    EXPECT_GT(model.size(), 500U);
    EXPECT_GT(model.coverage(), 0.5);
    std::vector<double> off;
    std::size_t coloured = 0, wrongHue = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const Vec3 p = pointOf(model, i);
        off.push_back(std::abs((p.cwiseAbs() - 0.5 * kSize).maxCoeff()));
        const auto& sum = model.colours[i];
        const OnFace on = nearestFace(p, kSize);
        if (sum.count == 0 || on.toEdge_m < 0.2) continue;
        ++coloured;
        // Speckles scale all channels alike, so their ratios are those of the face.
        const auto& truth = kFaces[static_cast<std::size_t>(on.face)];
        const Vec3 got(sum.mean[0], sum.mean[1], sum.mean[2]);
        const Vec3 want(truth[0], truth[1], truth[2]);
        if (got.normalized().dot(want.normalized()) < 0.99) ++wrongHue;
    }
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() / 2], 0.05);
    EXPECT_GT(coloured, 200U);
    EXPECT_LE(wrongHue, coloured / 100);
}

TEST(ObjectTexturer, SameViewsGiveSameBytes) {
    const BoxWorld world{{carBox(), carBox({5, 3, 0.75}, 1)}, Rgb{90, 90, 90}};
    const auto run = [&] {
        ObjectTexturer texturer;
        for (uint64_t frame = 0; frame < 2; ++frame) {
            auto view = viewFrom(world, {static_cast<double>(frame), -8, 1.7}, {1, 0, 0.75}, frame);
            view.objects.push_back(inView(kOther, world.boxes[1]));
            texturer.addView(view);
        }
        std::vector<float> numbers;
        for (const auto& [id, model] : texturer.models()) {
            for (std::size_t i = 0; i < model.size(); ++i) {
                const Vec3 p = pointOf(model, i);
                for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(p[k]));
                for (float c : model.colours[i].mean) numbers.push_back(c);
                for (float c : model.colours[i].m2) numbers.push_back(c);
            }
        }
        return numbers;
    };
    const auto first = run();
    EXPECT_GT(first.size(), 1000U);
    EXPECT_EQ(first, run());
}

TEST(ObjectTexturer, MergesTwoHalvesOfOneCar) {
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    ObjectTexturer texturer;
    texturer.addView(viewFrom(world, {7, -6, 3}, {0, 0, 0.75}, 0));
    // The same car again as another object, turned by half a circle, seen from the other side.
    const SE3 T_other_car = SE3::fromYaw(M_PI, Vec3::Zero());
    auto view = viewFrom(world, {-7, 6, 3}, {0, 0, 0.75}, 1);
    view.objects[0].id = kOther;
    view.objects[0].T_world_obj = world.boxes[0].T_world_box * T_other_car.inverse();
    texturer.addView(view);
    const std::size_t points =
        texturer.models().at(kCar).size() + texturer.models().at(kOther).size();
    texturer.mergeObjects(kCar, kOther, T_other_car.inverse());
    ASSERT_EQ(texturer.models().size(), 1U);
    const ObjectModel& model = texturer.models().at(kCar);
    EXPECT_LE(model.size(), points);
    EXPECT_GT(model.size(), points / 2);
    const Tally tally = compare(model, kFaces);
    EXPECT_EQ(tally.wrong, 0U);
    for (std::size_t face = 0; face < 4; ++face) EXPECT_GT(tally.colouredOnFace[face], 50U);
    EXPECT_THAT(model.views, testing::ElementsAre(FrameId{0}, FrameId{1}));
    texturer.removeObject(kCar);
    EXPECT_TRUE(texturer.models().empty());
}

TEST(ObjectTexturer, KeepsWithinItsLimits) {
    const BoxWorld world{{carBox(), carBox({0, 4, 0.75})}, Rgb{90, 90, 90}};
    TextureOptions options;
    options.max_points_per_object = 150;
    options.max_points_total = 200;
    ObjectTexturer texturer(options);
    for (uint64_t frame = 0; frame < 2; ++frame) {
        auto view = viewFrom(world, {6, -8, 3.5}, {0, 2, 0.75}, frame);
        view.objects.push_back(inView(kOther, world.boxes[1]));
        texturer.addView(view);
    }
    EXPECT_EQ(texturer.models().at(kCar).size(), 150U);
    EXPECT_EQ(texturer.models().at(kOther).size(), 50U);
}

TEST(ObjectTexturer, NothingInMeansNothingOut) {
    ObjectTexturer texturer;
    EXPECT_EQ(texturer.addView(TextureView()).pointsAdded, 0U);
    const BoxWorld world{{carBox()}, Rgb{90, 90, 90}};
    auto view = viewFrom(world, {7, -6, 3}, {0, 0, 0.75}, 0);
    view.scan->points.clear();
    texturer.addView(view);
    view.scan.reset();
    texturer.addView(view);  // no scan, no right image
    EXPECT_TRUE(texturer.models().empty());
    texturer.removeObject(kCar);
    texturer.mergeObjects(kOther, kCar, SE3());
    EXPECT_TRUE(texturer.models().empty());
}

TEST(ObjectTexturer, TellsBadInputInOneSentence) {
    const BoxWorld world{{carBox()}, std::nullopt};
    const auto good = viewFrom(world, {7, -6, 3}, {0, 0, 0.75}, 12);
    ObjectTexturer texturer;
    const auto message = [&](const TextureView& view) -> std::string {
        try {
            texturer.addView(view);
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    };
    auto view = good;
    view.objects.push_back(view.objects[0]);
    EXPECT_THAT(message(view), testing::HasSubstr("frame 12: object 7 is listed twice"));
    view = good;
    view.objects[0].mask = djpete::obs::RleMask{10, 10, {100}};
    EXPECT_THAT(message(view), testing::HasSubstr("frame 12: mask of object 7 is 10x10"));
    view = good;
    view.images.camera.model.width_px = 1242;
    EXPECT_THAT(message(view), testing::HasSubstr("400x240 but 1242x240 was expected"));
    view = good;
    view.images.left = mrpt::img::CImage();
    EXPECT_THAT(message(view), testing::HasSubstr("frame 12: no image"));
    view = good;
    view.images.camera.model.fx = 0;
    EXPECT_THAT(message(view), testing::HasSubstr("calibration"));
}

}  // namespace
