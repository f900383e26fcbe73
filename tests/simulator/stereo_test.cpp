// The two cameras see one rigid world: pictures agree through the rendered depth.
#include <gtest/gtest.h>

#include <cmath>

#include "djpete/simulator/renderer.h"

namespace {

using namespace djpete::simulator;
using djpete::geometry::Mat3;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;

struct Pair {
    djpete::geometry::StereoCamera camera = rigCamera(620, 188);
    RenderedImage left, right;
};

Pair renderPair(uint64_t frame) {
    WorldOptions options;
    options.seed = 2;
    const World world(options);
    Renderer renderer(world, 2);
    Pair out;
    const SE3 T_left_right(Mat3::Identity(), Vec3(out.camera.baseline_m, 0, 0));
    out.left = renderer.renderCamera(frame, out.camera, T_vehicle_camera(), 0);
    out.right = renderer.renderCamera(frame, out.camera, T_vehicle_camera() * T_left_right, 1);
    return out;
}

double greenAt(const RenderedImage& image, double u, std::size_t row) {
    const auto u0 = static_cast<std::size_t>(u);
    const double f = u - static_cast<double>(u0);
    return (1 - f) * image.rgb[row + u0][1] + f * image.rgb[row + u0 + 1][1];
}

struct Agreement {
    std::size_t seen = 0, shared = 0;
    double meanError = 0;  // grey levels, over shared pixels
};

/// Warps the left picture into the right one by depth; `shift_px` is added to the disparity.
Agreement compare(const Pair& p, double shift_px) {
    Agreement out;
    const auto w = static_cast<std::size_t>(p.camera.width_px);
    for (std::size_t v = 0; v < static_cast<std::size_t>(p.camera.height_px); ++v) {
        for (std::size_t u = 0; u < w; ++u) {
            const auto z = static_cast<double>(p.left.depth_m[v * w + u]);
            if (z <= 0) continue;
            const double uRight =
                static_cast<double>(u) - p.camera.fx * p.camera.baseline_m / z + shift_px;
            if (uRight < 0 || uRight >= static_cast<double>(w - 1)) continue;
            ++out.seen;
            const auto zRight = static_cast<double>(
                p.right.depth_m[v * w + static_cast<std::size_t>(std::lround(uRight))]);
            if (std::abs(zRight - z) > 0.03 * z) continue;  // hidden there
            ++out.shared;
            out.meanError += std::abs(p.left.rgb[v * w + u][1] - greenAt(p.right, uRight, v * w));
        }
    }
    out.meanError /= static_cast<double>(out.shared);
    return out;
}

TEST(Stereo, LeftWarpedByDepthIsRight) {
    const Pair pair = renderPair(10);
    const Agreement right = compare(pair, 0);
    EXPECT_GT(right.seen, 60000U);
    EXPECT_GT(static_cast<double>(right.shared), 0.85 * static_cast<double>(right.seen));
    EXPECT_LT(right.meanError, 5.0);
    // A wrong disparity would show.
    for (double shift_px : {-1.5, 1.5})
        EXPECT_GT(compare(pair, shift_px).meanError, 1.4 * right.meanError) << shift_px;
}

}  // namespace
