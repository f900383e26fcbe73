/// Silhouettes, masks and boxes painted by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "djpete/evaluation/silhouette_pairs.h"

namespace djpete::evaluation {
namespace {

using obs::ImageBox;
using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Optional;

constexpr int kWidth_px = 40, kHeight_px = 20;

MaskImage rectangle(int u0, int v0, int u1, int v1) {
    MaskImage out{kWidth_px, kHeight_px, std::vector<uint8_t>(kWidth_px * kHeight_px, 0)};
    for (int v = v0; v < v1; ++v) {
        for (int u = u0; u < u1; ++u) out.pixels[out.index(u, v)] = 255;
    }
    return out;
}

texture::RenderedModel rendered(const MaskImage& shape, float depth_m) {
    texture::RenderedModel out;
    out.width_px = shape.width_px;
    out.height_px = shape.height_px;
    for (const uint8_t pixel : shape.pixels) {
        out.point.push_back(pixel ? 0U : texture::RenderedModel::kNoPoint);
        out.depth_m.push_back(pixel ? depth_m : std::numeric_limits<float>::infinity());
        out.rgb.push_back({0, 0, 0});
    }
    return out;
}

TEST(SilhouetteBuffer, nearerObjectsHideFartherOnesInAnyOrder) {
    const auto near = rendered(rectangle(5, 5, 15, 15), 8);
    const auto far = rendered(rectangle(10, 5, 30, 15), 20);
    for (const bool nearFirst : {true, false}) {
        SilhouetteBuffer buffer(kWidth_px, kHeight_px);
        buffer.add(nearFirst ? near : far, 0);
        buffer.add(nearFirst ? far : near, 0);
        EXPECT_EQ(buffer.visible(nearFirst ? 0 : 1).pixels, rectangle(5, 5, 15, 15).pixels);
        EXPECT_EQ(buffer.visible(nearFirst ? 1 : 0).pixels, rectangle(15, 5, 30, 15).pixels);
        EXPECT_EQ(buffer.wholeArea(nearFirst ? 1 : 0), 200U);
    }
}

TEST(SilhouetteBuffer, nothingShowsThroughAClosedHole) {
    auto near = rendered(rectangle(5, 5, 15, 15), 8);
    const auto hole = MaskImage{kWidth_px, kHeight_px, {}}.index(10, 10);
    near.point[hole] = texture::RenderedModel::kNoPoint;
    SilhouetteBuffer buffer(kWidth_px, kHeight_px);
    buffer.add(near, 1);
    buffer.add(rendered(rectangle(10, 5, 30, 15), 20), 0);
    EXPECT_EQ(buffer.visible(0).pixels, rectangle(5, 5, 15, 15).pixels);
}

TEST(SilhouetteBuffer, aModelThatIsNotInTheImage) {
    SilhouetteBuffer buffer(kWidth_px, kHeight_px);
    EXPECT_EQ(buffer.add(rendered(rectangle(0, 0, 0, 0), 8), 1), 0U);
    EXPECT_EQ(area(buffer.visible(0)), 0U);
    EXPECT_FALSE(boxOf(buffer.visible(0)));
}

TEST(Boxes, ofAMask) {
    const auto box = boxOf(rectangle(3, 4, 10, 12));
    ASSERT_TRUE(box);
    EXPECT_EQ(box->left, 3);
    EXPECT_EQ(box->top, 4);
    EXPECT_EQ(box->right, 10);
    EXPECT_EQ(box->bottom, 12);
}

TEST(Boxes, ofACuboidAndItsPartInTheImage) {
    geometry::StereoCamera camera;
    camera.fx = camera.fy = 10;
    camera.cx = 5;
    camera.cy = 10;
    camera.width_px = kWidth_px;
    camera.height_px = kHeight_px;
    // 4 wide (x), 2 high (y), nearest face at z = 4: pixels 5 +- 5 and 10 +- 2.5.
    const auto box =
        projectedBox({4, 2, 2}, geometry::SE3(geometry::Mat3::Identity(), {0, 0, 5}), camera);
    ASSERT_TRUE(box);
    EXPECT_FLOAT_EQ(box->left, 0);
    EXPECT_FLOAT_EQ(box->right, 10);
    EXPECT_FLOAT_EQ(box->top, 7.5);
    EXPECT_FLOAT_EQ(box->bottom, 12.5);
    camera.cx = 0;
    const auto half =
        projectedBox({4, 2, 2}, geometry::SE3(geometry::Mat3::Identity(), {0, 0, 5}), camera);
    EXPECT_FLOAT_EQ(partInImage(*half, camera).area(), 0.5F * half->area());
    EXPECT_FALSE(projectedBox({4, 2, 2}, geometry::SE3(geometry::Mat3::Identity(), {0, 0, 1}),
                              camera));  // the camera is in it
}

TEST(Pairing, isOneToOneAndBestInAll) {
    const ImageBox a{0, 0, 10, 10}, b{6, 0, 16, 10};
    // a overlaps the first truth more (0.60) than the second (0.43), but b has no other (0.48).
    const std::vector<ImageBox> truths{{2.5F, 0, 12.5F, 10}, {-4, 0, 6, 10}};
    EXPECT_THAT(pairByBoxes({a, b}, truths, 0.2), ElementsAre(Optional(1U), Optional(0U)));
    EXPECT_THAT(pairByBoxes({a, b}, {truths[0]}, 0.2), ElementsAre(Optional(0U), Eq(std::nullopt)));
}

TEST(Pairing, weakOverlapsAreNone) {
    const ImageBox a{0, 0, 10, 10}, aside{8, 0, 18, 10};  // IoU 1/9
    EXPECT_THAT(pairByBoxes({a}, {aside}, 0.2), ElementsAre(Eq(std::nullopt)));
    EXPECT_THAT(pairByBoxes({a}, {aside}, 0.1), ElementsAre(Optional(0U)));
    EXPECT_THAT(pairByBoxes({a}, {ImageBox{20, 0, 30, 10}}, 0), ElementsAre(Eq(std::nullopt)));
    EXPECT_THAT(pairByBoxes({a}, {}, 0.2), ElementsAre(Eq(std::nullopt)));
    EXPECT_TRUE(pairByBoxes({}, {a}, 0.2).empty());
}

TEST(Fit, countsWhatIsTooMuchAndWhatIsMissing) {
    const auto fit = fitSilhouette(rectangle(0, 0, 10, 10), rectangle(5, 0, 20, 10), {});
    ASSERT_TRUE(fit);
    EXPECT_DOUBLE_EQ(fit->iou, 50.0 / 200);
    EXPECT_DOUBLE_EQ(fit->excess, 0.5);
    EXPECT_DOUBLE_EQ(fit->missing, 100.0 / 150);
}

TEST(Fit, pixelsOfOtherInstancesDoNotCount) {
    const auto silhouette = rectangle(0, 0, 10, 10), mask = rectangle(5, 0, 20, 10);
    const auto fit = fitSilhouette(silhouette, mask, rectangle(0, 0, 5, 10));
    ASSERT_TRUE(fit);
    EXPECT_DOUBLE_EQ(fit->iou, 50.0 / 150);
    EXPECT_DOUBLE_EQ(fit->excess, 0);
    EXPECT_FALSE(fitSilhouette(silhouette, mask, rectangle(0, 0, 10, 10)));
}

}  // namespace
}  // namespace djpete::evaluation
