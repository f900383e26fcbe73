#include <algorithm>
#include <cmath>

#include "noise.h"
#include "parallel.h"
#include "renderer_impl.h"

namespace djpete::simulator {

namespace {

constexpr int kBeams = 64;

/// The two blocks of an HDL-64E: a third of a degree apart above, half a degree below.
double elevation_rad(int beam) {
    const double deg = beam < 32 ? 2.0 - beam / 3.0 : -8.83 - 0.5 * (beam - 32);
    return deg * M_PI / 180.0;
}

}  // namespace

std::vector<LidarPoint> Renderer::scan(uint64_t frame, const LidarOptions& options) {
    impl_->setFrame(frame);
    const geometry::SE3 T_world_velo = impl_->scene.world().T_world_vehicle(frame);
    const auto columns = static_cast<int>(std::lround(360.0 / options.azimuthStep_deg));
    const uint32_t seed =
        hash(impl_->scene.world().options().seed, static_cast<uint32_t>(frame), 900U);
    std::vector<std::vector<LidarPoint>> beams(kBeams);
    parallelFor(kBeams, impl_->threads, [&](int beam) {
        const double elevation = elevation_rad(beam);
        for (int c0 = 0; c0 < columns; c0 += 8) {
            std::array<Ray, 8> rays;
            std::array<geometry::Vec3, 8> d_velo;
            std::array<bool, 8> active{};
            std::array<Hit, 8> hits;
            for (int i = 0; i < 8; ++i) {
                const auto at = static_cast<std::size_t>(i);
                active[at] = c0 + i < columns;
                const double azimuth = -2.0 * M_PI * (c0 + i) / columns;  // clockwise from ahead
                d_velo[at] = {std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
                rays[at] = {T_world_velo.translation().cast<float>(),
                            (T_world_velo.rotation() * d_velo[at]).cast<float>()};
            }
            impl_->scene.cast(rays, active, hits);
            for (std::size_t i = 0; i < 8; ++i) {
                if (!hits[i].any() || static_cast<double>(hits[i].distance_m) > options.maxRange_m)
                    continue;
                Vec3f normal;
                const Shade seen = shade(impl_->scene.surface(rays[i], hits[i], 0.003F, normal));
                const float facing = std::clamp(-normal.dot(rays[i].direction), 0.F, 1.F);
                const float reflectance = seen.reflectance * (0.4F + 0.6F * facing);
                const uint32_t h = hash(seed, static_cast<uint32_t>(beam),
                                        static_cast<uint32_t>(c0) + static_cast<uint32_t>(i));
                // Dark and grazing surfaces lose returns.
                if (unit(hash(h, 7U)) < 0.35F * std::max(0.F, 0.12F - reflectance) / 0.12F ||
                    unit(hash(h, 8U)) > seen.returns)
                    continue;
                const double range = static_cast<double>(hits[i].distance_m) +
                                     options.rangeNoise_m * static_cast<double>(gaussian(h));
                const geometry::Vec3 p = range * d_velo[i];
                beams[static_cast<std::size_t>(beam)].push_back(
                    {static_cast<float>(p.x()), static_cast<float>(p.y()),
                     static_cast<float>(p.z()),
                     std::round(100.F * std::clamp(reflectance, 0.F, 0.99F)) / 100.F,
                     hits[i].actor == kNoHit ? 0U
                                             : impl_->scene.world().actors()[hits[i].actor].id});
            }
        }
    });
    std::vector<LidarPoint> out;
    for (const auto& beam : beams) out.insert(out.end(), beam.begin(), beam.end());
    return out;
}

}  // namespace djpete::simulator
