/// Outputs of a segmentation network, made by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "detect_objects_app.h"
#include "djpete/obs/errors.h"
#include "segmentation_network.h"

namespace djpete::detect_objects {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kCandidates = 4;

/// 116 rows of kCandidates; prototype 0 is 1 in its left half, -1 in the right one.
struct Outputs {
    Outputs() : boxes(3, boxSizes, CV_32F, cv::Scalar(0)), protos(4, protoSizes, CV_32F) {
        protos = cv::Scalar(0);
        for (int v = 0; v < 80; ++v) {
            for (int u = 0; u < 264; ++u) {
                protos.ptr<float>(0, 0, v)[u] = u < 132 ? 1.F : -1.F;
            }
        }
    }
    void put(int i, const cv::Rect2f& box, int coco, float p) {
        const float rows[] = {box.x + box.width / 2, box.y + box.height / 2, box.width, box.height};
        for (int r = 0; r < 4; ++r) boxes.at<float>(0, r, i) = rows[r];
        boxes.at<float>(0, 4 + coco, i) = p;
        boxes.at<float>(0, 84, i) = 5;
    }
    const int boxSizes[3] = {1, 116, kCandidates}, protoSizes[4] = {1, 32, 80, 264};
    cv::Mat boxes, protos;
};

TEST(SegmentationNetwork, boxesAndMasksComeBackIntoTheImage) {
    // 1242 x 375 shrinks by 0.85, rows centred.
    const auto letterbox = letterboxOf({1242, 375}, {1056, 320});
    EXPECT_NEAR(letterbox.scale, 0.85024, 1e-5);
    EXPECT_EQ(letterbox.left_px, 0);
    EXPECT_EQ(letterbox.top_px, 1);
    Outputs out;
    out.put(0, {478, 100, 100, 60}, 2, 0.9F);
    const auto found = decodeSegmentation(out.boxes, out.protos, letterbox);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].objectClass, obs::ObjectClass::Car);
    EXPECT_FLOAT_EQ(found[0].score, 0.9F);
    EXPECT_NEAR(found[0].box->left, 478 / letterbox.scale, 0.01);
    EXPECT_NEAR(found[0].box->bottom, 159 / letterbox.scale, 0.01);
    ASSERT_TRUE(found[0].mask);
    EXPECT_EQ(found[0].mask->width_px, 1242U);
    // The left half of the box, to column 528 of the input: 50 x 60 of its pixels.
    const double expected = 50 * 60 / (letterbox.scale * letterbox.scale);
    EXPECT_NEAR(double(found[0].mask->area_px()), expected, 0.04 * expected);
}

TEST(SegmentationNetwork, keepsTheSurestOfOverlappingVehiclesAndLeavesOthersOut) {
    Outputs out;
    out.put(0, {100, 100, 100, 60}, 7, 0.5F);
    out.put(1, {102, 101, 100, 60}, 2, 0.8F);  // the same vehicle, surer
    out.put(2, {400, 100, 100, 60}, 2, 0.2F);  // unsure
    out.put(3, {600, 100, 100, 60}, 9, 0.9F);  // a traffic light
    const auto found =
        decodeSegmentation(out.boxes, out.protos, letterboxOf({1242, 375}, {1056, 320}));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].objectClass, obs::ObjectClass::Car);
}

TEST(SegmentationNetwork, otherNetworksAreRefused) {
    Outputs out;
    const int sizes[] = {1, 84, kCandidates};
    const cv::Mat detector(3, sizes, CV_32F, cv::Scalar(0));
    EXPECT_THAT(
        [&] {
            decodeSegmentation(detector, out.protos, letterboxOf({1242, 375}, {1056, 320}));
        },
        ThrowsMessage<obs::InputError>(HasSubstr("[1, 116, N]")));
    EXPECT_THAT([] { SegmentationNetwork("/nowhere.onnx"); },
                ThrowsMessage<obs::InputError>(HasSubstr("/nowhere.onnx: cannot be read")));
}

TEST(SegmentationNetwork, theProgramNeedsItsFile) {
    const char* without[] = {"detect-objects", "d.rawlog", "--observer", "network"};
    DetectObjectsApp app;
    EXPECT_THAT([&] { app.initialize(4, without); },
                ThrowsMessage<obs::InputError>(HasSubstr("--network need each other")));
    const char* good[] = {"detect-objects", "a/d.rawlog", "--observer",
                          "network",        "--network",  "n.onnx"};
    EXPECT_TRUE(app.initialize(6, good));
    EXPECT_EQ(app.job.out, "a/d_masks.rawlog");  // djpete-slam takes d_objects.rawlog by itself
}

}  // namespace
}  // namespace djpete::detect_objects
