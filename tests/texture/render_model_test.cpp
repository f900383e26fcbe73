#include "djpete/texture/render_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace djpete::texture;
using djpete::geometry::SE3;
using djpete::geometry::StereoCamera;

StereoCamera camera() {
    StereoCamera out;
    out.fx = out.fy = 200;
    out.cx = 99.5;
    out.cy = 59.5;
    out.width_px = 200;
    out.height_px = 120;
    return out;
}

/// A plate in the plane z = depth of the camera, from -half to half in x and y; frame obj = cam.
void addPlate(double depth, double half, const std::array<float, 3>& rgb, ObjectModel& model) {
    constexpr double kStep = 0.05;
    for (double x = -half; x <= half; x += kStep) {
        for (double y = -half; y <= half; y += kStep) {
            const std::size_t i = model.size();
            model.addPoint(
                {static_cast<float>(x), static_cast<float>(y), static_cast<float>(depth)},
                {0, 0, -1}, 0.05F);
            model.colours[i].add(rgb, 1);
            model.showColour(i);
        }
    }
}

std::size_t pixel(int u, int v) { return static_cast<std::size_t>(v * 200 + u); }

TEST(RenderModel, ShowsAPlateInItsColourAtItsDepth) {
    ObjectModel model;
    addPlate(5, 1, {200, 100, 50}, model);
    const RenderedModel image = renderModel(model, camera(), SE3());
    // 1 m at 5 m with 200 px: 40 px to each side.
    std::size_t covered = 0;
    for (std::size_t k = 0; k < image.point.size(); ++k) covered += image.covered(k) ? 1U : 0U;
    EXPECT_NEAR(static_cast<double>(covered), 80 * 80, 0.12 * 80 * 80);
    const std::size_t middle = pixel(100, 60);
    EXPECT_NEAR(image.depth_m[middle], 5, 1e-3);
    EXPECT_EQ(image.rgb[middle], (std::array<uint8_t, 3>{200, 100, 50}));
    EXPECT_FALSE(image.covered(pixel(5, 5)));
    EXPECT_TRUE(std::isinf(image.depth_m[pixel(5, 5)]));
}

TEST(RenderModel, TheNearerPlateHidesTheOther) {
    for (const bool smooth : {true, false}) {
        ObjectModel model;
        addPlate(6, 1.5, {10, 250, 10}, model);
        addPlate(4, 0.4, {250, 10, 10}, model);
        RenderOptions options;
        options.smooth = smooth;
        const RenderedModel image = renderModel(model, camera(), SE3(), options);
        EXPECT_EQ(image.rgb[pixel(100, 60)], (std::array<uint8_t, 3>{250, 10, 10}));
        EXPECT_EQ(image.rgb[pixel(135, 60)], (std::array<uint8_t, 3>{10, 250, 10}));
    }
}

TEST(RenderModel, TiltedPlatesHaveTheirOwnDepthAtEveryPixel) {
    ObjectModel model;
    // x + z = 5: seen at 45 degrees.
    const float s = std::sqrt(0.5F);
    for (float x = -1; x <= 1; x += 0.04F) {
        for (float y = -1; y <= 1; y += 0.04F) {
            model.addPoint({x, y, 5 - x}, {-s, 0, -s}, 0.06F);
        }
    }
    const RenderedModel image = renderModel(model, camera(), SE3());
    for (const int u : {85, 92, 100, 107, 115}) {
        const double ray = (u - 99.5) / 200;
        EXPECT_NEAR(image.depth_m[pixel(u, 60)], 5 / (1 + ray), 0.02) << u;
    }
}

TEST(RenderModel, LeavesOutWhatItIsAskedTo) {
    ObjectModel model;
    addPlate(5, 1, {200, 100, 50}, model);
    model.addPoint({0, 0, 3}, {0, 0, -1}, 0.3F);  // without a colour
    RenderOptions options;
    EXPECT_NEAR(renderModel(model, camera(), SE3(), options).depth_m[pixel(100, 60)], 3, 1e-3);
    options.onlySeen = true;
    EXPECT_NEAR(renderModel(model, camera(), SE3(), options).depth_m[pixel(100, 60)], 5, 1e-3);
    options.maxTilt_cos = 0.5;
    const SE3 fromBehind = SE3(djpete::geometry::so3Exp({0, M_PI, 0}), {0, 0, 10});
    EXPECT_FALSE(renderModel(model, camera(), fromBehind, options).covered(pixel(100, 60)));
}

}  // namespace
