#include <algorithm>
#include <cmath>

#include "lidar_model.h"
#include "noise.h"
#include "parallel.h"
#include "renderer_impl.h"
#include "vehicle_motion.h"

namespace djpete::simulator {

namespace {

/// Where the scanner is and looks when it fires its column `c`.
struct Column {
    double azimuth_rad = 0;  ///< counter-clockwise from ahead
    geometry::SE3 T_world_velo;
};

/// The columns of a turn in the order of KITTI's files: counter-clockwise, the first ahead. The
/// scanner turns the same way, starts at the back and looks ahead when the cameras fire.
std::vector<Column> columnsOf(const World& world, uint64_t frame, const LidarOptions& options) {
    const auto n = static_cast<int>(std::lround(360.0 / options.azimuthStep_deg));
    std::vector<Column> out(static_cast<std::size_t>(n));
    for (int c = 0; c < n; ++c) {
        auto& column = out[static_cast<std::size_t>(c)];
        column.azimuth_rad = 2.0 * M_PI * c / n;
        const double turn = static_cast<double>(c) / n;
        const double share = options.raw ? (turn < 0.5 ? turn : turn - 1.0) : 0.0;
        column.T_world_velo = vehicleBetween(world, frame, share);
    }
    return out;
}

/// A ray that met something.
struct Pulse {
    Ray ray;
    Hit hit;
    geometry::Vec3 d_velo;
    uint32_t number;  ///< for noise
};

/// One beam's turn.
struct BeamTracer {
    const RayScene& scene;
    const LidarOptions& options;
    const std::vector<Column>& columns;
    uint32_t seed;

    std::vector<LidarPoint> trace(int beam) const {
        const Laser laser = laserOf(beam, options);
        const double elevation = laser.elevation_rad;
        std::vector<LidarPoint> out;
        out.reserve(columns.size());
        for (std::size_t c0 = 0; c0 < columns.size(); c0 += 8) {
            std::array<Ray, 8> rays;
            std::array<geometry::Vec3, 8> d_velo;
            std::array<bool, 8> active{};
            std::array<Hit, 8> hits;
            for (std::size_t i = 0; i < 8; ++i) {
                const Column& column = columns[std::min(c0 + i, columns.size() - 1)];
                active[i] =
                    c0 + i < columns.size() && !hiddenByOwnCar(column.azimuth_rad, elevation);
                d_velo[i] = {std::cos(elevation) * std::cos(column.azimuth_rad),
                             std::cos(elevation) * std::sin(column.azimuth_rad),
                             std::sin(elevation)};
                rays[i] = {column.T_world_velo.translation().cast<float>(),
                           (column.T_world_velo.rotation() * d_velo[i]).cast<float>()};
            }
            scene.cast(rays, active, hits);
            for (std::size_t i = 0; i < 8; ++i) {
                if (!active[i] || !hits[i].any()) continue;
                const uint32_t h =
                    hash(seed, static_cast<uint32_t>(beam), static_cast<uint32_t>(c0 + i));
                if (auto point = receive({rays[i], hits[i], d_velo[i], h}, laser)) {
                    point->beam = static_cast<uint8_t>(beam);
                    out.push_back(*point);
                }
            }
        }
        return out;
    }

    /// The point of a pulse unless its echo is lost.
    std::optional<LidarPoint> receive(const Pulse& pulse, const Laser& laser) const {
        const auto& [ray, hit, d_velo, h] = pulse;
        const auto distance = static_cast<double>(hit.distance_m);
        if (distance > options.maxRange_m) return std::nullopt;
        Vec3f normal;
        const SurfacePoint point = scene.surface(ray, hit, 0.003F, normal);
        const Shade seen = shade(point);
        const float facing = std::clamp(-normal.dot(ray.direction), 0.F, 1.F);
        const Echo echo = echoOf(point, seen, facing, hit.distance_m);
        // Echoes near the limit are lost now and then; glass lets most pulses through.
        if (echo.strength < between(hash(h, 7U), 0.8F, 1.2F) || unit(hash(h, 8U)) > echo.returns)
            return std::nullopt;
        const double range = distance + laser.bias_m +
                             rangeSigma_m(options, distance) * static_cast<double>(gaussian(h));
        const geometry::Vec3 p = range * d_velo;
        const float speckle = laser.gain + 0.1F * gaussian(hash(h, 9U));
        // One pulse in nine meets dirt, wet or rough patches and is stated far too dark.
        const float patch = unit(hash(h, 12U)),
                    dim = unit(hash(h, 11U)) < 0.11F ? patch * patch : 1.F;
        const float reflectance = echo.reflectance > 0.98F ? echo.reflectance
                                                           : dim * echo.reflectance * speckle -
                                                                 0.05F * unit(hash(h, 10U));
        LidarPoint out;
        out.x = static_cast<float>(p.x());
        out.y = static_cast<float>(p.y());
        out.z = static_cast<float>(p.z());
        out.reflectance = std::round(100.F * std::clamp(reflectance, 0.F, 0.99F)) / 100.F;
        if (hit.actor != kNoHit) out.actorId = scene.world().actors()[hit.actor].id;
        return out;
    }
};

}  // namespace

std::vector<LidarPoint> Renderer::scan(uint64_t frame, const LidarOptions& options) {
    impl_->setFrame(frame);
    const World& world = impl_->scene.world();
    const auto columns = columnsOf(world, frame, options);
    const uint32_t seed = hash(world.driveSeed(), static_cast<uint32_t>(frame), 900U);
    const BeamTracer tracer{impl_->scene, options, columns, seed};
    std::vector<std::vector<LidarPoint>> beams(kLidarBeams);
    parallelFor(kLidarBeams, impl_->threads,
                [&](int beam) { beams[static_cast<std::size_t>(beam)] = tracer.trace(beam); });
    std::vector<LidarPoint> out;
    for (const auto& beam : beams) out.insert(out.end(), beam.begin(), beam.end());
    return out;
}

}  // namespace djpete::simulator
