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
    const auto scan = scene.renderer.scan(20, {});
    // KITTI's scans of such streets have 115,000 to 125,000 points of 2150 x 64 pulses.
    EXPECT_GT(scan.size(), 105000U);
    EXPECT_LT(scan.size(), 130000U);
    std::set<int> rings;
    double highest = -90, lowest = 90, lastAzimuth = 7;
    int lastBeam = -1;
    for (const auto& p : scan) {
        const Vec3 x = at(p);
        EXPECT_LT(x.norm(), 80.3);
        EXPECT_GE(p.reflectance, 0);
        EXPECT_LT(p.reflectance, 1);
        const double elevation = std::asin(x.z() / x.norm()) * 180 / M_PI;
        highest = std::max(highest, elevation);
        lowest = std::min(lowest, elevation);
        // An HDL-64E: 32 beams a third of a degree apart, below them 32 half a degree apart, each
        // a little beside its place.
        const double ring =
            elevation > -8.58 ? 3 * (2.0 - elevation) : 32 + 2 * (-8.83 - elevation);
        EXPECT_NEAR(ring, p.beam, 0.45);
        rings.insert(p.beam);
        // Beam after beam, each counter-clockwise from ahead.
        double azimuth = std::atan2(x.y(), x.x());
        if (azimuth < -1e-6) azimuth += 2 * M_PI;
        if (p.beam == lastBeam) {
            EXPECT_GT(azimuth, lastAzimuth);
        } else {
            EXPECT_EQ(p.beam, lastBeam + 1);
        }
        lastAzimuth = azimuth;
        lastBeam = p.beam;
    }
    EXPECT_NEAR(highest, 2.0, 0.15);
    EXPECT_NEAR(lowest, -24.33, 0.15);
    EXPECT_EQ(rings.size(), 64U);
}

TEST(SimulatedScans, AreBlindWhereTheOwnCarStandsInTheWay) {
    Scene scene(2);
    int bonnet = 0, behind = 0, left = 0;
    for (const auto& p : scene.renderer.scan(20, {})) {
        const double azimuth = std::atan2(p.y, p.x) * 180 / M_PI;
        bonnet += p.beam > 60 && std::abs(azimuth) < 8 ? 1 : 0;
        behind += p.beam > 54 && std::abs(azimuth) > 165 ? 1 : 0;
        left += p.beam > 60 && std::abs(azimuth - 90) < 8 ? 1 : 0;
    }
    EXPECT_EQ(bonnet, 0);
    EXPECT_EQ(behind, 0);
    EXPECT_GT(left, 150);
}

TEST(SimulatedScans, ReflectanceTellsMaterialsApart) {
    Scene scene(1);
    const SE3 T_world_velo = scene.world.T_world_vehicle(20);
    double bright = 0, zero = 0, n = 0, far = 0, near = 0, nFar = 0, nNear = 0;
    for (const auto& p : scene.renderer.scan(20, {})) {
        n += 1;
        bright += p.reflectance >= 0.985F ? 1 : 0;
        zero += p.reflectance == 0 ? 1 : 0;
        const bool ground = std::abs((T_world_velo * at(p)).z()) < 0.1;
        const double range = at(p).norm();
        if (ground && range < 15) near += p.reflectance, nNear += 1;
        if (ground && range > 35) far += p.reflectance, nFar += 1;
    }
    // KITTI's scans: 0.02 to 0.12 % plates and signs, 8 to 14 % of the echoes are stated as 0.
    EXPECT_GT(bright / n, 0.0002);
    EXPECT_LT(bright / n, 0.008);
    EXPECT_GT(zero / n, 0.02);
    EXPECT_LT(zero / n, 0.2);
    EXPECT_GT(near / nNear, 0.15);
    EXPECT_LT(near / nNear, 0.35);
    ASSERT_GT(nFar, 20);
    EXPECT_LT(far / nFar, 0.8 * near / nNear);
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
            // People are a quarter as wide.
            const bool person = l.type == "Pedestrian" || l.type == "Cyclist";
            EXPECT_GT(inBox[id], person ? 10 : 30) << sim::toKittiRow(l);
            ++near;
        }
        EXPECT_GT(near, 1);
    }
    EXPECT_GT(onCars, 3000);
}

TEST(SimulatedScans, RangesHaveTheNoiseAskedFor) {
    Scene scene(3);
    sim::LidarOptions exact, noisy;
    exact.rangeNoise_m = exact.rangeNoisePerMetre = exact.beamBias_m = noisy.beamBias_m = 0;
    const auto truth = scene.renderer.scan(2, exact);
    const auto measured = scene.renderer.scan(2, noisy);
    ASSERT_EQ(truth.size(), measured.size());  // noise neither adds nor drops points
    struct Sum {
        double n = 0, sum = 0, squares = 0, range = 0;
    } near, far;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double range = at(truth[i]).norm(), e = at(measured[i]).norm() - range;
        EXPECT_LT(at(measured[i]).normalized().cross(at(truth[i]).normalized()).norm(), 1e-5);
        if (range > 6 && range < 30) continue;
        Sum& s = range < 20 ? near : far;
        s.n += 1;
        s.sum += e;
        s.squares += e * e;
        s.range += std::hypot(noisy.rangeNoise_m, noisy.rangeNoisePerMetre * range);
    }
    for (const Sum& s : {near, far}) {
        const double sigma = s.range / s.n;
        EXPECT_GT(s.n, 1000);
        EXPECT_NEAR(s.sum / s.n, 0, 4 * sigma / std::sqrt(s.n));
        EXPECT_NEAR(std::sqrt(s.squares / s.n) / sigma, 1, 0.08);
    }
}

TEST(SimulatedScans, BeamsHaveOffsetsOfTheirOwn) {
    Scene scene(3);
    sim::LidarOptions exact, biased;
    exact.rangeNoise_m = biased.rangeNoise_m = 0;
    exact.rangeNoisePerMetre = biased.rangeNoisePerMetre = exact.beamBias_m = 0;
    const auto truth = scene.renderer.scan(1, exact);
    const auto measured = scene.renderer.scan(1, biased);
    ASSERT_EQ(truth.size(), measured.size());
    std::map<int, double> offset;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double e = at(measured[i]).norm() - at(truth[i]).norm();
        const auto first = offset.emplace(truth[i].beam, e).first;
        EXPECT_NEAR(e, first->second, 2e-5);  // of a beam always the same
    }
    double squares = 0;
    for (const auto& [beam, e] : offset) squares += e * e;
    EXPECT_NEAR(std::sqrt(squares / 64), 0.01, 4 * 0.01 / std::sqrt(2 * 64));
}

TEST(SimulatedScans, RawOnesAreDistortedByTheMotionDuringTheTurn) {
    Scene scene(4);
    sim::LidarOptions still;
    still.rangeNoise_m = still.rangeNoisePerMetre = still.beamBias_m = 0;
    sim::LidarOptions raw = still;
    raw.raw = true;
    const uint64_t frame = 20;
    const auto T = [&](uint64_t f) { return scene.world.T_world_vehicle(f); };
    // Where the vehicle is when the scanner looks there: ahead at the frame's instant; it begins at
    // the back half a frame earlier, turns counter-clockwise, and ends there half a frame later.
    const auto atItsTime = [&](const sim::LidarPoint& p) {
        const double share = std::atan2(p.y, p.x) / (2 * M_PI);
        const auto from = T(share < 0 ? frame - 1 : frame), to = T(share < 0 ? frame : frame + 1);
        return from * SE3::exp((share < 0 ? 1 + share : share) * (from.inverse() * to).log());
    };
    // Points on parked cars behind, which the vehicle passes meanwhile, must lie in their boxes.
    std::map<uint32_t, sim::Actor> parked;
    for (const auto& a : scene.world.actors()) {
        if (!a.moving) parked[a.id] = a;
    }
    const auto shareInBoxes = [&](const sim::LidarOptions& options, auto&& T_world_velo) {
        double in = 0, all = 0;
        for (const auto& p : scene.renderer.scan(frame, options)) {
            if (p.x > -3 || parked.count(p.actorId) == 0) continue;
            const auto& car = parked.at(p.actorId);
            const Vec3 p_obj =
                scene.world.T_world_obj(car, frame).inverse() * T_world_velo(p) * at(p);
            in += djpete::geometry::Cuboid{car.size_m}.contains(p_obj, 0.01) ? 1 : 0;
            ++all;
        }
        EXPECT_GT(all, 300);
        return in / all;
    };
    const auto atTheInstant = [&](const sim::LidarPoint&) { return T(frame); };
    EXPECT_EQ(shareInBoxes(still, atTheInstant), 1.0);
    EXPECT_EQ(shareInBoxes(raw, atItsTime), 1.0);
    EXPECT_LT(shareInBoxes(raw, atTheInstant), 0.97);
}
