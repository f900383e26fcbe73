#include "djpete/places/place_view.h"

#include <gmock/gmock.h>

#include "djpete_test/synthetic_world.h"

namespace djpete::places {
namespace {

/// A feature at (700, 200) with a descriptor of one set bit.
obs::KeyframeFeature feature(unsigned bit) {
    obs::KeyframeFeature f;
    f.u_px = 700;
    f.v_px = 200;
    f.sigma_px = 0.2F;
    f.descriptor.emplace();
    (*f.descriptor)[0] = uint64_t{1} << bit;
    return f;
}

map::Keyframe keyframe(std::vector<obs::KeyframeFeature> features) {
    map::Keyframe k;
    k.id.value = 9;
    k.camera = djpete_test::kittiLikeCamera();
    k.landmarks.resize(features.size());
    k.features = std::move(features);
    return k;
}

TEST(PlaceView, holdsTheFeaturesWithADescriptor) {
    auto plain = feature(0);
    plain.descriptor.reset();
    const PlaceView view = placeView(keyframe({plain, feature(1), plain, feature(2)}));
    EXPECT_EQ(view.id.value, 9U);
    ASSERT_EQ(view.corners.size(), 2U);
    EXPECT_EQ(view.corners[0].feature, 1U);
    EXPECT_EQ(view.corners[1].feature, 3U);
    EXPECT_EQ(view.corners[1].descriptor[0], 4U);
    EXPECT_EQ(view.corners[0].px, geometry::Vec2(700, 200));
    EXPECT_FALSE(view.corners[0].p_cam);
}

TEST(PlaceView, stereoGivesAPoint) {
    auto f = feature(1);
    f.uRight_px = 690.F;
    f.uRightSigma_px = 0.25F;
    const PlaceView view = placeView(keyframe({f}));
    ASSERT_TRUE(view.corners[0].p_cam);
    const auto uvu = view.camera.projectStereo(*view.corners[0].p_cam);
    EXPECT_NEAR((uvu - geometry::Vec3(700, 200, 690)).norm(), 0, 1e-9);
    const double perDisparity = 1 / (view.camera.fx * view.camera.baseline_m);
    EXPECT_NEAR(view.corners[0].inverseDepthSigma, 0.25 * perDisparity, 1e-12);
}

TEST(PlaceView, aDisparityThatMayBeNoiseGivesNoPoint) {
    auto f = feature(1);
    f.uRight_px = 699.5F;
    f.uRightSigma_px = 0.25F;
    EXPECT_FALSE(placeView(keyframe({f})).corners[0].p_cam);
    f.uRight_px = 701.F;  // behind infinity
    EXPECT_FALSE(placeView(keyframe({f})).corners[0].p_cam);
}

TEST(PlaceView, stereoAndScanAreWeighed) {
    auto f = feature(1);
    f.depth_m = 20.F;
    f.depthSigma_m = 0.02F;
    const PlaceView scan = placeView(keyframe({f}));
    ASSERT_TRUE(scan.corners[0].p_cam);
    EXPECT_NEAR(scan.corners[0].p_cam->z(), 20, 1e-4);
    EXPECT_NEAR(scan.corners[0].inverseDepthSigma, 0.02 / 400, 1e-8);

    f.uRight_px = 690.F;  // 38.6 m, of less worth
    f.uRightSigma_px = 0.5F;
    const PlaceView both = placeView(keyframe({f}));
    EXPECT_GT(both.corners[0].p_cam->z(), 20);
    EXPECT_LT(both.corners[0].p_cam->z(), 20.2);
    EXPECT_LT(both.corners[0].inverseDepthSigma, scan.corners[0].inverseDepthSigma);
}

}  // namespace
}  // namespace djpete::places
