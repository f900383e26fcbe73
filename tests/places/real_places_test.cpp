/// Real images: what the front end describes is known again from elsewhere.
#include <gmock/gmock.h>

#include "djpete/places/view_match.h"
#include "djpete_test/shared_data.h"
#include "kitti_folder.h"

namespace djpete::places {
namespace {

/// The view of one frame by a front end that saw nothing before.
PlaceView viewOf(const djpete_test::KittiFolder& folder, std::size_t frame) {
    obs::LidarScan unused;
    frontend::VisualOdometry odometry;
    const auto seen = odometry.process(folder.load(frame, unused));
    map::Keyframe keyframe;
    keyframe.id.value = frame;
    keyframe.camera = seen->camera;
    keyframe.features = seen->features;
    return placeView(keyframe);
}

TEST(RealPlaces, framesOfKittiKnowEachOther) {
    DJPETE_SHARED_OR_SKIP(kitti, "data/kitti/odometry");
    auto folder = djpete_test::KittiFolder::odometry(kitti / "sequences" / "00", false);
    folder.scans.clear();
    const auto truth = djpete_test::readPoses(kitti / "poses" / "00.txt");
    const PlaceView a = viewOf(folder, 20);
    ASSERT_GT(a.corners.size(), 300U);
    for (const std::size_t frame : {22U, 24U, 26U}) {
        const PlaceView b = viewOf(folder, frame);
        const auto T_a_b = truth.at(20).inverse() * truth.at(frame);
        const auto match = matchViews(a, b, {}, 1);
        ASSERT_TRUE(match) << frame;
        const auto T_error = T_a_b.inverse() * match->T_a_b;
        EXPECT_LT(T_error.translation().norm(), 0.05 + 0.03 * T_a_b.translation().norm());
        EXPECT_LT(T_error.angle_rad(), 0.01);
        const auto near = matchViewsNear(a, b, T_a_b, {});
        ASSERT_TRUE(near);
        EXPECT_GE(near->features.size() + 10, match->features.size());
    }
    const PlaceView elsewhere = viewOf(folder, 95);
    EXPECT_FALSE(matchViews(a, elsewhere, {}, 1));
}

}  // namespace
}  // namespace djpete::places
