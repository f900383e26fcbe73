/// OXTS rows lead back to the true poses the way KITTI's readers go.
#include "djpete/simulator/oxts.h"

#include "small_drive.h"

using namespace small_drive;

namespace {

std::vector<double> rowOf(const sim::World& world, uint64_t frame, const sim::OxtsNoise& noise) {
    std::istringstream in(sim::oxtsRow(world, frame, noise));
    std::vector<double> v{std::istream_iterator<double>(in), std::istream_iterator<double>()};
    EXPECT_EQ(v.size(), 30U);
    EXPECT_TRUE(in.eof());
    return v;
}

/// KITTI's way from a row to a pose: Mercator scaled at the first latitude, then Rz Ry Rx.
SE3 poseOfRow(const std::vector<double>& v, double scale) {
    constexpr double kEarth_m = 6378137.0;
    const Vec3 t(scale * v[1] * M_PI * kEarth_m / 180,
                 scale * kEarth_m * std::log(std::tan((90 + v[0]) * M_PI / 360)), v[2]);
    const auto about = [](const Vec3& axis, double angle) {
        return SE3(djpete::geometry::so3Exp(angle * axis), Vec3::Zero());
    };
    return SE3(djpete::geometry::Mat3::Identity(), t) * about(Vec3::UnitZ(), v[5]) *
           about(Vec3::UnitY(), v[4]) * about(Vec3::UnitX(), v[3]);
}

const sim::OxtsNoise kNone{0, 0, 0, 0, 0};

}  // namespace

TEST(SimulatedOxts, LeadsBackToTheTruePoses) {
    const sim::World world(Scene::options(3));
    const double scale = std::cos(rowOf(world, 0, kNone)[0] * M_PI / 180);
    const SE3 T_geo_first = poseOfRow(rowOf(world, 0, kNone), scale);
    for (uint64_t f : {1U, 7U, 35U}) {
        const SE3 T_first_imu = T_geo_first.inverse() * poseOfRow(rowOf(world, f, kNone), scale);
        const SE3 truth = (world.T_world_vehicle(0) * sim::T_velo_imu()).inverse() *
                          world.T_world_vehicle(f) * sim::T_velo_imu();
        const SE3 error = truth.inverse() * T_first_imu;
        // 13 digits of a longitude are a tenth of a micrometre; the sphere adds nothing here.
        EXPECT_LT(error.translation().norm(), 1e-5) << f;
        EXPECT_LT(error.angle_rad(), 1e-9) << f;
    }
}

TEST(SimulatedOxts, VelocitiesRatesAndGravity) {
    const sim::World world(Scene::options(3));
    for (uint64_t f : {1U, 12U}) {
        const auto v = rowOf(world, f, kNone);
        const auto p = [&](uint64_t frame) {
            return (world.T_world_vehicle(frame) * sim::T_velo_imu()).translation();
        };
        const Vec3 expected = (p(f + 1) - p(f - 1)) / 0.2;
        EXPECT_NEAR(v[7], expected.x(), 0.01);  // ve
        EXPECT_NEAR(v[6], expected.y(), 0.01);  // vn
        EXPECT_NEAR(v[10], expected.z(), 0.01);
        EXPECT_NEAR(std::hypot(v[8], v[9]), std::hypot(v[6], v[7]), 1e-9);
        EXPECT_NEAR(v[8], 8.0, 0.1);  // forward: 0.8 m per 0.1 s
        const double yawRate =
            (rowOf(world, f + 1, kNone)[5] - rowOf(world, f - 1, kNone)[5]) / 0.2;
        EXPECT_NEAR(v[19], yawRate, 0.005);
        EXPECT_NEAR(v[13], 9.81, 1.0);
        EXPECT_NEAR(v[16], v[13], 0.1);
    }
}

TEST(SimulatedOxts, ErrAsMuchAsAskedAndTheSameEveryTime) {
    const sim::World world(Scene::options(5));
    sim::OxtsNoise noise = kNone;
    noise.velocity_mps = 0.05;
    noise.position_m = 0.5;
    double squares = 0, jumps = 0, far = 0;
    const int n = 400;
    Vec3 last = Vec3::Zero();
    for (int f = 0; f < n; ++f) {
        const auto frame = static_cast<uint64_t>(f);
        const auto a = rowOf(world, frame, noise), b = rowOf(world, frame, kNone);
        EXPECT_EQ(a, rowOf(world, frame, noise));
        squares += (a[10] - b[10]) * (a[10] - b[10]);
        const double metres = M_PI * 6378137.0 / 180;
        const Vec3 e((a[0] - b[0]) * metres, (a[1] - b[1]) * metres * std::cos(49.0 * M_PI / 180),
                     a[2] - b[2]);
        far = std::max(far, e.norm());
        if (f > 0) jumps = std::max(jumps, (e - last).norm());
        last = e;
    }
    EXPECT_NEAR(std::sqrt(squares / n), 0.05, 4 * 0.05 / std::sqrt(2.0 * n));
    EXPECT_GT(far, 0.5);
    EXPECT_LT(jumps, 0.1);  // positions glide
}

TEST(SimulatedOxts, CalibrationIsInAFileOfKittisForm) {
    const auto dir = djpete_test::scratch("sim_imu_calibration");
    simulate(
        {"--out", dir.string(), "--frames", "3:4", "--size", "64x32", "--no-scans", "--no-color"});
    std::istringstream in(textOf(dir / "calib_imu_to_velo.txt"));
    std::string key;
    double x = 0, y = 0, z = 0, r = 0;
    std::getline(in, key);
    EXPECT_EQ(key.rfind("calib_time:", 0), 0U);
    in >> key >> r;
    EXPECT_EQ(key, "R:");
    EXPECT_EQ(r, 1.0);
    while (in >> key && key != "T:") continue;
    in >> x >> y >> z;
    EXPECT_LT((Vec3(x, y, z) - sim::T_velo_imu().translation()).norm(), 1e-6);
    EXPECT_EQ(numbersOf(dir / "oxts" / "000003.txt").at(0).size(), 30U);
}
