#include "djpete/texture/background_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "box_world.h"

namespace {

using namespace djpete_test;
using djpete::map::ObjectId;
using djpete::obs::FrameId;
using djpete::texture::BackgroundCloud;
using djpete::texture::BackgroundCloudOptions;
using djpete::texture::TextureView;

const Rgb kGround{90, 90, 90}, kHouse{200, 120, 40}, kCarRgb{20, 30, 230};

BoxWorld street() {
    BoxWorld world;
    world.ground = kGround;
    world.boxes.push_back({SE3::fromYaw(0, {15, 8, 3}), Vec3(20, 2, 6), allFaces(kHouse), 0.15});
    world.boxes.push_back(
        {SE3::fromYaw(0, {12, 2, 0.75}), Vec3(4, 1.8, 1.5), allFaces(kCarRgb), 0.15});
    return world;
}

TextureView viewOf(const BoxWorld& world, uint64_t frame, bool stereo) {
    TextureView view;
    view.frame = FrameId{frame};
    auto& camera = view.images.camera.model;
    camera = smallCamera();
    view.T_world_vehicle = SE3::fromYaw(0, {0, 0, 1.7});
    view.T_world_cam = lookAt({0.2, 0, 1.6}, {10, 2, 1.5});
    view.images.left = world.image(camera, view.T_world_cam);
    if (stereo) {
        camera.baseline_m = 0.4;
        view.images.right = world.image(
            camera, view.T_world_cam * SE3(djpete::geometry::Mat3::Identity(), Vec3(0.4, 0, 0)));
    } else {
        view.scan = world.scan(view.T_world_vehicle);
    }
    djpete::texture::ObjectInView car;
    car.id = ObjectId{0};
    car.size_m = world.boxes[1].size_m;
    car.T_world_obj = world.boxes[1].T_world_box;
    view.objects.push_back(car);
    return view;
}

TEST(BackgroundCloud, HoldsGroundAndHousesInTheirColoursButNoCar) {
    BackgroundCloud cloud;
    EXPECT_GT(cloud.addView(viewOf(street(), 0, false)), 500U);
    std::size_t ground = 0, house = 0, other = 0;
    for (const auto& p : cloud.points()) {
        // House is speckled, so compare hue: red well above blue.
        const bool isGround = p.rgb == kGround;
        const bool isHouse = p.rgb[0] > 3 * p.rgb[2];
        (isGround ? ground : isHouse ? house : other) += 1;
        if (isGround) {
            EXPECT_NEAR(p.z, 0, 0.02);
        }
    }
    EXPECT_GT(ground, 200U);
    EXPECT_GT(house, 200U);
    EXPECT_LE(other, (ground + house) / 50);  // seams between two colours
}

TEST(BackgroundCloud, WorksFromStereoToo) {
    // Ground and sky have no texture, so stereo must not invent points there.
    const BoxWorld world = street();
    const auto view = viewOf(world, 0, true);
    BackgroundCloud cloud;
    EXPECT_GT(cloud.addView(view), 200U);
    const auto& camera = view.images.camera.model;
    std::size_t right = 0;
    for (const auto& p : cloud.points()) {
        const Vec3 fromCamera = Vec3(p.x, p.y, p.z) - view.T_world_cam.translation();
        const Hit hit = world.cast(view.T_world_cam.translation(), fromCamera);
        const double depth = (view.T_world_cam.rotation().transpose() * fromCamera).z();
        const double disparity = camera.fx * camera.baseline_m / depth;
        // hit.range is in units of the point's own distance; within a pixel of the half image.
        if (hit.box == 0 && std::abs(disparity - disparity / hit.range) < 2) ++right;
    }
    EXPECT_GT(right, 9 * cloud.size() / 10);
}

TEST(BackgroundCloud, KeepsOnePointPerVoxelAndTheLimit) {
    BackgroundCloud cloud;
    cloud.addView(viewOf(street(), 0, false));
    const std::size_t once = cloud.size();
    EXPECT_EQ(cloud.addView(viewOf(street(), 1, false)), 0U);
    EXPECT_EQ(cloud.size(), once);
    EXPECT_EQ(cloud.points().size(), once);
    BackgroundCloudOptions options;
    options.max_points = 100;
    BackgroundCloud small(options);
    EXPECT_EQ(small.addView(viewOf(street(), 0, false)), 100U);
}

TEST(BackgroundCloud, ItsPointsFollowTheCorrectedMap) {
    const auto view = viewOf(street(), 5, false);
    BackgroundCloud cloud;
    cloud.addView(view);
    djpete::map::SlamMap map;
    djpete::map::Keyframe keyframe;
    keyframe.frame = FrameId{5};
    keyframe.camera = view.images.camera.model;
    keyframe.T_vehicle_cam = view.T_world_vehicle.inverse() * view.T_world_cam;
    const SE3 correction = SE3::fromYaw(0.2, {1, -2, 0.5});
    keyframe.T_world_cam = correction * view.T_world_cam;
    map.addKeyframe(keyframe, true);
    const auto before = cloud.points(), after = cloud.points(map);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 moved = correction * Vec3(before[i].x, before[i].y, before[i].z);
        EXPECT_LT((moved - Vec3(after[i].x, after[i].y, after[i].z)).norm(), 1e-4);
    }
}

}  // namespace
