/// Depth, disparity and both pictures tell the same.
#include <algorithm>

#include "small_drive.h"

using namespace small_drive;

namespace {

double greyOf(const sim::RenderedImage& image, int u, int v) {
    const auto& p = image.rgb[image.index(u, v)];
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
}

sim::RenderedImage rightOf(Scene& scene, uint64_t frame) {
    const SE3 T_left_right(djpete::geometry::Mat3::Identity(), Vec3(scene.camera.baseline_m, 0, 0));
    return scene.renderer.renderCamera(frame, scene.camera, sim::T_vehicle_camera() * T_left_right,
                                       1);
}

}  // namespace

TEST(SimulatedStereo, LeftDepthMeetsRightDepthAtItsDisparity) {
    Scene scene(1);
    const auto left = scene.left(6);
    const auto right = rightOf(scene, 6);
    int visible = 0, agree = 0, behind = 0;
    for (int v = 0; v < left.height_px; ++v) {
        for (int u = 0; u < left.width_px; ++u) {
            const double z = left.depth_m[left.index(u, v)];
            if (z <= 0) continue;
            const double at = u - scene.camera.fx * scene.camera.baseline_m / z;
            const int r = static_cast<int>(std::lround(at));
            if (r < 0) continue;
            const double other = right.depth_m[right.index(r, v)];
            if (other > 0 && other < 0.95 * z) continue;  // hidden from the right camera
            ++visible;
            // Half a pixel beside it a slanted surface is a little nearer or farther.
            agree += std::abs(other - z) < 0.05 * z ? 1 : 0;
            behind += other == 0 || other > 1.3 * z ? 1 : 0;
        }
    }
    EXPECT_GT(visible, left.width_px * left.height_px / 2);
    EXPECT_GT(agree, 0.93 * visible);
    EXPECT_LT(behind, 0.04 * visible);  // outlines, leaves
}

TEST(SimulatedStereo, PicturesAgreeAtTheTrueDisparityAndNotBesideIt) {
    Scene scene(2);
    const auto left = scene.left(6);
    const auto right = rightOf(scene, 6);
    const auto difference = [&](int beside) {
        std::vector<double> out;
        for (int v = 0; v < left.height_px; ++v) {
            for (int u = 0; u < left.width_px; ++u) {
                const double z = left.depth_m[left.index(u, v)];
                if (z <= 0 || z > 25) continue;
                const double at = u - scene.camera.fx * scene.camera.baseline_m / z;
                const int r = static_cast<int>(std::lround(at)) + beside;
                if (std::abs(at - std::round(at)) > 0.1 || r < 0 || r >= left.width_px) continue;
                if (std::abs(right.depth_m[right.index(r, v)] - z) > 0.05 * z) continue;
                out.push_back(std::abs(greyOf(left, u, v) - greyOf(right, r, v)));
            }
        }
        EXPECT_GT(out.size(), 2000U);
        double sum = 0;
        for (double d : out) sum += d;
        return sum / static_cast<double>(out.size());
    };
    const double here = difference(0);
    EXPECT_LT(here, 6);
    EXPECT_GT(difference(3), 1.6 * here);
    EXPECT_GT(difference(-3), 1.6 * here);
}

TEST(SimulatedStereo, WorldPointsKeepTheirLookWhileTheRigDrives) {
    // A point of the road seen from two frames has the same brightness, its neighbour has not.
    Scene scene(4);
    const auto a = scene.left(6), b = scene.left(7);
    const SE3 T_b_a = (scene.world.T_world_vehicle(7) * sim::T_vehicle_camera()).inverse() *
                      scene.world.T_world_vehicle(6) * sim::T_vehicle_camera();
    double here = 0, beside = 0;
    int n = 0;
    for (int v = 0; v < a.height_px; ++v) {
        for (int u = 0; u < a.width_px; ++u) {
            const double z = a.depth_m[a.index(u, v)];
            if (z <= 0 || z > 20 || a.actorId[a.index(u, v)] != 0) continue;
            const Vec3 p = T_b_a * scene.camera.backProject({u, v}, z);
            if (p.z() < 1) continue;
            const auto uv = scene.camera.project(p);
            if (!scene.camera.contains(uv, 6)) continue;
            const int bu = static_cast<int>(std::lround(uv.x()));
            const int bv = static_cast<int>(std::lround(uv.y()));
            if (std::abs(b.depth_m[b.index(bu, bv)] - p.z()) > 0.05 * p.z()) continue;
            here += std::abs(greyOf(a, u, v) - greyOf(b, bu, bv));
            beside += std::abs(greyOf(a, u, v) - greyOf(b, bu + 4, bv + 2));
            ++n;
        }
    }
    EXPECT_GT(n, 5000);
    EXPECT_GT(beside, 1.4 * here);
}
