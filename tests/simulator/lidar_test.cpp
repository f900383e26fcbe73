/// Scans against pattern, boxes and the picture's truth.
#include <algorithm>
#include <set>

#include "djpete/geometry/cuboid.h"
#include "small_drive.h"

using namespace small_drive;

namespace {

Vec3 at(const sim::LidarPoint& p) { return Vec3(p.x, p.y, p.z); }

/// Car at a pixel if all its neighbours show it too, else 0.
uint32_t innerCar(const sim::RenderedImage& image, int u, int v) {
    if (u < 1 || v < 1 || u + 2 > image.width_px || v + 2 > image.height_px) return 0;
    const uint32_t id = image.actorId[image.index(u, v)];
    for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
            if (image.actorId[image.index(u + du, v + dv)] != id) return 0;
        }
    }
    return id;
}

}  // namespace

TEST(SimulatedScans, HaveKittisPattern) {
    Scene scene(1);
    const auto scan = scene.renderer.scan(3, {});
    EXPECT_GT(scan.size(), 70000U);
    EXPECT_LT(scan.size(), 130000U);
    std::set<int> rings;
    double highest = -90, lowest = 90;
    for (const auto& p : scan) {
        const Vec3 x = at(p);
        EXPECT_LT(x.norm(), 80.1);
        EXPECT_GE(p.reflectance, 0);
        EXPECT_LT(p.reflectance, 1);
        const double elevation = std::asin(x.z() / x.norm()) * 180 / M_PI;
        highest = std::max(highest, elevation);
        lowest = std::min(lowest, elevation);
        // An HDL-64E: 32 beams a third of a degree apart, below them 32 half a degree apart.
        const double ring =
            elevation > -8.58 ? 3 * (2.0 - elevation) : 32 + 2 * (-8.83 - elevation);
        EXPECT_NEAR(ring, std::round(ring), 0.02);
        rings.insert(static_cast<int>(std::lround(ring)));
    }
    EXPECT_NEAR(highest, 2.0, 0.01);
    EXPECT_NEAR(lowest, -24.33, 0.01);
    EXPECT_EQ(rings.size(), 64U);
}

TEST(SimulatedScans, SeeTheGroundWhereItIs) {
    Scene scene(2);
    int ground = 0;
    const SE3 T_world_velo = scene.world.T_world_vehicle(0);
    for (const auto& p : scene.renderer.scan(0, {})) {
        const Vec3 p_world = T_world_velo * at(p);
        EXPECT_GT(p_world.z(), -0.12);  // the meadow lies 5 cm below the road
        const Vec3 x = at(p);
        if (std::hypot(x.x(), x.y()) < 8 && std::abs(x.y() - 1.6) < 3) {
            ground += std::abs(p_world.z()) < 0.05 ? 1 : 0;
        }
    }
    EXPECT_GT(ground, 5000);
}

TEST(SimulatedScans, PointsOnACarLieInItsBox) {
    int onCars = 0;
    for (uint32_t seed : {1U, 8U}) {
        Scene scene(seed, 1241, 376);
        const auto image = scene.left(4);
        std::map<uint32_t, sim::Label> labels;
        for (const auto& l : scene.labels(4, image)) labels[l.trackId] = l;
        const SE3 T_cam_velo = sim::T_vehicle_camera().inverse();
        std::map<uint32_t, int> inBox;
        for (const auto& p : scene.renderer.scan(4, {})) {
            const Vec3 p_cam = T_cam_velo * at(p);
            for (const auto& [id, l] : labels) {
                const djpete::geometry::Cuboid box{{l.length_m, l.width_m, l.height_m}};
                // Without the lowest 20 cm, where the ground would count too.
                const Vec3 p_obj = poseOf(l).inverse() * p_cam;
                if (box.contains(p_obj, 0.1) && p_obj.z() > 0.2 - 0.5 * l.height_m) ++inBox[id];
            }
            if (p_cam.z() < 1) continue;
            const auto uv = scene.camera.project(p_cam);
            if (!scene.camera.contains(uv)) continue;
            const int u = static_cast<int>(std::lround(uv.x()));
            const int v = static_cast<int>(std::lround(uv.y()));
            const auto label = labels.find(innerCar(image, u, v));
            if (label == labels.end()) continue;
            // The LiDAR may look past a car that hides what is behind from the camera.
            if (std::abs(image.depth_m[image.index(u, v)] - p_cam.z()) > 0.1) continue;
            const sim::Label& l = label->second;
            EXPECT_TRUE((djpete::geometry::Cuboid{{l.length_m, l.width_m, l.height_m}}.contains(
                poseOf(l).inverse() * p_cam, 0.1)))
                << "car " << l.trackId << ", point " << p_cam.transpose();
            ++onCars;
        }
        int near = 0;
        for (const auto& [id, l] : labels) {
            if (l.occlusion > 0 || l.truncation > 0.3 || l.z_m > 30) continue;
            EXPECT_GT(inBox[id], 30) << sim::toKittiRow(l);
            ++near;
        }
        EXPECT_GT(near, 1);
    }
    EXPECT_GT(onCars, 3000);
}

TEST(SimulatedScans, RangesHaveTheNoiseAskedFor) {
    Scene scene(3);
    sim::LidarOptions exact;
    exact.rangeNoise_m = 0;
    const auto truth = scene.renderer.scan(2, exact);
    const auto noisy = scene.renderer.scan(2, {});
    ASSERT_EQ(truth.size(), noisy.size());  // noise neither adds nor drops points
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double e = at(noisy[i]).norm() - at(truth[i]).norm();
        EXPECT_LT(at(noisy[i]).normalized().cross(at(truth[i]).normalized()).norm(), 1e-5);
        sum += e;
        squares += e * e;
    }
    const auto n = static_cast<double>(truth.size());
    EXPECT_NEAR(sum / n, 0, 5e-4);
    EXPECT_NEAR(std::sqrt(squares / n), 0.02, 5e-4);
}
