/// Corners of keyframes are described so that they can be known again.
#include "descriptor.h"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

#include "synthetic_street.h"

namespace djpete::frontend {
namespace {

using obs::KeyframeFeature;

unsigned differing(const obs::Descriptor& a, const obs::Descriptor& b) {
    unsigned sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (uint64_t x = a[i] ^ b[i]; x != 0; x &= x - 1) ++sum;
    }
    return sum;
}

/// A rough image without any pattern.
cv::Mat rough(uint32_t seed) {
    cv::Mat image(240, 320, CV_8U);
    for (int y = 0; y < image.rows; ++y) {
        for (int x = 0; x < image.cols; ++x) {
            image.at<uint8_t>(y, x) =
                static_cast<uint8_t>(djpete_test::textureGrey(0.02 * x, 0.02 * y, 0.02, seed));
        }
    }
    return image;
}

KeyframeFeature at(float u, float v) {
    KeyframeFeature f;
    f.u_px = u;
    f.v_px = v;
    return f;
}

obs::Descriptor describeOne(const cv::Mat& image, float u, float v) {
    std::vector<KeyframeFeature> features{at(u, v)};
    describe(image, features);
    return *features[0].descriptor;
}

TEST(Descriptor, followsTheImageWhenItMoves) {
    const cv::Mat image = rough(1);
    cv::Mat moved = cv::Mat::zeros(image.size(), CV_8U);
    image(cv::Rect(0, 0, 310, 233)).copyTo(moved(cv::Rect(10, 7, 310, 233)));
    EXPECT_EQ(describeOne(image, 100, 80), describeOne(moved, 110, 87));
}

TEST(Descriptor, staysInOtherLight) {
    const cv::Mat image = rough(2);
    cv::Mat darker;
    image.convertTo(darker, CV_8U, 0.6, 20);
    EXPECT_LT(differing(describeOne(image, 150, 100), describeOne(darker, 150, 100)), 16U);
}

TEST(Descriptor, changesLittleWithNoiseAndMuchWithThePlace) {
    const cv::Mat image = rough(3);
    cv::Mat noisy = image.clone();
    uint64_t state = 1;
    for (int i = 0; i < image.rows * image.cols; ++i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        const int value = image.data[i] + static_cast<int>(state >> 60) - 8;
        noisy.data[i] = static_cast<uint8_t>(std::clamp(value, 0, 255));
    }
    unsigned nearest = 256;
    for (float u = 40; u < 280; u += 30) {
        EXPECT_LT(differing(describeOne(image, u, 120), describeOne(noisy, u, 120)), 40U);
        for (float other = 40; other < 280; other += 30) {
            if (other == u) continue;
            nearest = std::min(
                nearest, differing(describeOne(image, u, 120), describeOne(image, other, 120)));
        }
    }
    EXPECT_GT(nearest, 60U);
}

TEST(Descriptor, bitsAreBalanced) {
    const cv::Mat image = rough(4);
    std::vector<KeyframeFeature> features;
    for (float v = 20; v < 220; v += 12) {
        for (float u = 20; u < 300; u += 12) features.push_back(at(u, v));
    }
    describe(image, features);
    for (std::size_t bit = 0; bit < 256; ++bit) {
        std::size_t set = 0;
        for (const auto& f : features) set += (*f.descriptor)[bit / 64] >> (bit % 64) & 1;
        EXPECT_GT(set, features.size() / 5) << bit;
        EXPECT_LT(set, features.size() * 4 / 5) << bit;
    }
}

TEST(Descriptor, cornersAtTheBorderHaveOneToo) {
    const cv::Mat image = rough(5);
    std::vector<KeyframeFeature> features{at(0, 0), at(319, 239), at(0.4F, 238.6F)};
    describe(image, features);
    for (const auto& f : features) EXPECT_TRUE(f.descriptor);
    features.clear();
    describe(image, features);
}

TEST(Descriptor, theSameWithAndWithoutOpenCvsOptimisations) {
    const cv::Mat image = rough(6);
    const auto fast = describeOne(image, 99.3F, 70.8F);
    cv::setUseOptimized(false);
    const auto plain = describeOne(image, 99.3F, 70.8F);
    cv::setUseOptimized(true);
    EXPECT_EQ(fast, plain);
}

TEST(Descriptor, everyFeatureOfAKeyframeIsDescribed) {
    const djpete_test::SyntheticStreet street;
    VisualOdometry odometry;
    const auto first = odometry.process(street.frame(0, geometry::SE3()));
    ASSERT_TRUE(first->isKeyframe);
    ASSERT_GT(first->features.size(), 100U);
    for (const auto& f : first->features) EXPECT_TRUE(f.descriptor);
}

}  // namespace
}  // namespace djpete::frontend
