/// What the camera makes of the light: exposure, vignetting, noise, blur.
#include <algorithm>
#include <cmath>

#include "small_drive.h"

using namespace small_drive;

namespace {

sim::WorldOptions street(uint32_t seed) {
    sim::WorldOptions o;
    o.seed = seed;
    o.frames = 40;
    return o;
}

/// Without what a test does not look at.
sim::CameraModel plain() {
    sim::CameraModel m;
    m.autoExposure = false;
    m.vignetting = m.shotNoise = m.readNoise = 0;
    m.blur_px = m.shutterShare = 0;
    return m;
}

sim::RenderedImage picture(const sim::CameraModel& model, uint64_t frame, uint32_t noise = 0) {
    const sim::World world(street(3));
    sim::Renderer renderer(world, 2, model);
    return renderer.renderCamera(frame, sim::rigCamera(310, 94), sim::T_vehicle_camera(), noise);
}

double meanGreen(const sim::RenderedImage& image) {
    double sum = 0;
    for (const auto& p : image.rgb) sum += p[1];
    return sum / static_cast<double>(image.rgb.size());
}

}  // namespace

TEST(CameraModel, ExposureIsTheSameWhateverWasRenderedBefore) {
    const sim::World world(street(3));
    const auto camera = sim::rigCamera(310, 94);
    sim::Renderer through(world, 2), alone(world, 1);
    std::vector<double> exposures;
    sim::RenderedImage last;
    for (uint64_t f = 0; f <= 20; ++f) {
        last = through.renderCamera(f, camera, sim::T_vehicle_camera(), 0);
        exposures.push_back(last.exposure);
    }
    const auto right = through.renderCamera(20, camera, sim::T_vehicle_camera(), 1);
    const auto image = alone.renderCamera(20, camera, sim::T_vehicle_camera(), 0);
    EXPECT_EQ(image.exposure, last.exposure);
    EXPECT_EQ(image.rgb, last.rgb);
    EXPECT_EQ(right.exposure, last.exposure);  // triggered together
    for (std::size_t i = 1; i < exposures.size(); ++i)
        EXPECT_NEAR(exposures[i], exposures[i - 1], 0.08 * exposures[i]) << "frame " << i;
    const auto [least, most] = std::minmax_element(exposures.begin(), exposures.end());
    EXPECT_GT(*most - *least, 1e-3);  // it does follow
    EXPECT_GE(*least, sim::CameraModel().leastExposure);
    EXPECT_LE(*most, sim::CameraModel().mostExposure);
}

TEST(CameraModel, GainOfTheRightCameraIsItsOwn) {
    auto model = plain();
    model.rightGain = 1.2;
    const auto left = picture(model, 5, 0), right = picture(model, 5, 1);  // from the same place
    EXPECT_DOUBLE_EQ(left.exposure, 1);
    EXPECT_DOUBLE_EQ(right.exposure, 1.2);
    EXPECT_GT(meanGreen(right), meanGreen(left) + 4);
}

TEST(CameraModel, VignettingDarkensCornersOnly) {
    auto model = plain();
    const auto even = picture(model, 5);
    model.vignetting = 0.3;
    const auto dark = picture(model, 5);
    double corner = 0, centre = 0;
    for (int v = 0; v < even.height_px; ++v) {
        for (int u = 0; u < even.width_px; ++u) {
            const double loss = even.rgb[even.index(u, v)][1] - dark.rgb[even.index(u, v)][1];
            EXPECT_GE(loss, 0);
            const double r = std::hypot(u - 151.7, v - 46.3) / 165.0;
            if (r > 0.9) corner = std::max(corner, loss);
            if (r < 0.1) centre = std::max(centre, loss);
        }
    }
    EXPECT_LE(centre, 1);
    EXPECT_GT(corner, 10);
}

TEST(CameraModel, NoiseHasTheStatedSizeAndGrowsWithLight) {
    auto model = plain();
    const auto clean = picture(model, 5);
    model.shotNoise = 4e-4;
    const auto noisy = picture(model, 5);
    double sum[2] = {0, 0};
    int n[2] = {0, 0};
    for (std::size_t i = 0; i < clean.rgb.size(); ++i) {
        const double is = clean.rgb[i][1], error = noisy.rgb[i][1] - is;
        if (is < 40 || is > 220) continue;
        const std::size_t k = is > 110 ? 1 : 0;
        // Luma and the colour's own noise; both pictures are quantised.
        const double expected = 255 * 4e-4 * is * (1 + 0.5 * 0.5) + 2.0 / 12;
        sum[k] += error * error / expected;
        ++n[k];
    }
    for (std::size_t k : {0U, 1U}) {
        EXPECT_GT(n[k], 1000);
        EXPECT_NEAR(sum[k] / n[k], 1.0, 0.12) << (k == 0 ? "dark" : "bright");
    }
}

TEST(CameraModel, BlurSoftensAndMotionBlurLeavesTheWayAheadSharp) {
    auto model = plain();
    const auto sharp = picture(model, 5);
    const auto roughness = [](const sim::RenderedImage& image, int from, int to) {
        double sum = 0;
        for (int v = 0; v < image.height_px; ++v)
            for (int u = from; u + 1 < to; ++u)
                sum +=
                    std::abs(image.rgb[image.index(u + 1, v)][1] - image.rgb[image.index(u, v)][1]);
        return sum;
    };
    model.blur_px = 0.8;
    const auto soft = picture(model, 5);
    EXPECT_LT(roughness(soft, 0, 310), 0.8 * roughness(sharp, 0, 310));
    EXPECT_NEAR(meanGreen(soft), meanGreen(sharp), 3);
    EXPECT_EQ(soft.depth_m, sharp.depth_m);
    model = plain();
    model.shutterShare = 0.2;
    const auto moved = picture(model, 5);
    EXPECT_LT(roughness(moved, 0, 80), 0.9 * roughness(sharp, 0, 80));
    EXPECT_GT(roughness(moved, 135, 170), 0.85 * roughness(sharp, 135, 170));
}
