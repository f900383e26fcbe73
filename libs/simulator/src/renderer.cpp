#include "djpete/simulator/renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "noise.h"
#include "parallel.h"
#include "ray_scene.h"

namespace djpete::simulator {

namespace {

using geometry::SE3;

constexpr int kSamples = 2;  // per pixel, on the diagonal
constexpr float kImageNoise = 1.6F;

const Vec3f& sun() {
    static const Vec3f s = Vec3f(0.35F, 0.48F, 0.80F).normalized();
    return s;
}

/// Scene brightness to 8 bit: exposure and a gentle gamma.
float toneMap(float linear) {
    return 255.F * std::pow(std::clamp(1.02F * linear, 0.F, 1.F), 0.62F);
}

}  // namespace

struct Renderer::Impl {
    Impl(const World& world, unsigned n) : scene(world), threads(std::max(1U, n)) {}

    void setFrame(uint64_t frame) {
        if (current && *current == frame) return;
        scene.setFrame(frame);
        current = frame;
    }

    /// Colours of eight rays; `pixelAngle` in radians sets the texture filter.
    void shadeRays(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active,
                   float pixelAngle, std::array<Hit, 8>& hits,
                   std::array<Vec3f, 8>& colours) const {
        scene.cast(rays, active, hits);
        std::array<Ray, 8> toSun;
        std::array<Vec3f, 8> normals;
        std::array<bool, 8> lit{}, blocked{};
        std::array<Shade, 8> shades;
        for (std::size_t i = 0; i < 8; ++i) {
            toSun[i] = {Vec3f::Zero(), sun()};
            if (!active[i] || !hits[i].any()) continue;
            SurfacePoint s = scene.surface(rays[i], hits[i], normals[i]);
            const float slant = std::max(0.12F, -normals[i].dot(rays[i].direction));
            s.footprint_m = 0.6F * pixelAngle * hits[i].distance_m / std::sqrt(slant);
            shades[i] = shade(s);
            lit[i] = normals[i].dot(sun()) > 0;
            toSun[i].origin =
                rays[i].origin + hits[i].distance_m * rays[i].direction + 0.01F * normals[i];
        }
        scene.occluded(toSun, lit, 120.F, blocked);
        for (std::size_t i = 0; i < 8; ++i) {
            if (!active[i]) continue;
            if (!hits[i].any()) {
                colours[i] = sky(rays[i].direction);
                continue;
            }
            const Vec3f& n = normals[i];
            const float direct = lit[i] && !blocked[i] ? 0.62F * n.dot(sun()) : 0.F;
            const float ambient = 0.30F + 0.14F * n.z() + 0.04F * n.x();
            Vec3f c = shades[i].albedo * (direct + ambient);
            if (shades[i].gloss > 0) {
                const Vec3f d = rays[i].direction - 2.F * rays[i].direction.dot(n) * n;
                const Vec3f mirrored = d.z() > 0 ? sky(d) : Vec3f(0.22F, 0.22F, 0.21F);
                c += shades[i].gloss * mirrored;
            }
            colours[i] = c;
        }
    }

    void renderRow(int v, const geometry::StereoCamera& camera, const SE3& T_world_cam,
                   uint32_t noise, RenderedImage& out) const {
        const Eigen::Matrix3f R = T_world_cam.rotation().cast<float>();
        const Vec3f origin = T_world_cam.translation().cast<float>();
        const auto pixelAngle = static_cast<float>(1.0 / camera.fx);
        for (int u0 = 0; u0 < camera.width_px; u0 += 8) {
            std::array<Vec3f, 8> sum;
            sum.fill(Vec3f::Zero());
            std::array<bool, 8> active{};
            std::array<Hit, 8> hits;
            for (int k = 0; k < kSamples; ++k) {
                const double shift = kSamples == 1 ? 0.0 : -0.25 + 0.5 * k;
                std::array<Ray, 8> rays;
                std::array<Vec3f, 8> colours;
                for (int i = 0; i < 8; ++i) {
                    const auto at = static_cast<std::size_t>(i);
                    active[at] = u0 + i < camera.width_px;
                    const geometry::Vec3 d = camera.ray({u0 + i + shift, v - shift * 0.9});
                    rays[at] = {origin, (R * d.cast<float>()).normalized()};
                }
                shadeRays(rays, active, pixelAngle, hits, colours);
                for (std::size_t i = 0; i < 8; ++i) {
                    if (active[i]) sum[i] += colours[i];
                }
            }
            finishPixels(u0, v, camera, T_world_cam, active, sum, noise, out);
        }
    }

    /// Noise and quantisation; truth from a ray through the pixel centre.
    void finishPixels(int u0, int v, const geometry::StereoCamera& camera, const SE3& T_world_cam,
                      const std::array<bool, 8>& active, const std::array<Vec3f, 8>& sum,
                      uint32_t noise, RenderedImage& out) const {
        std::array<Ray, 8> rays;
        std::array<float, 8> zPerMetre{};
        for (std::size_t i = 0; i < 8; ++i) {
            const geometry::Vec3 d =
                camera.ray({u0 + static_cast<double>(i), static_cast<double>(v)});
            zPerMetre[i] = static_cast<float>(1.0 / d.norm());
            rays[i] = {T_world_cam.translation().cast<float>(),
                       (T_world_cam.rotation() * d.normalized()).cast<float>()};
        }
        std::array<Hit, 8> hits;
        scene.cast(rays, active, hits);
        for (std::size_t i = 0; i < 8; ++i) {
            if (!active[i]) continue;
            const auto at =
                static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width_px) +
                static_cast<std::size_t>(u0) + i;
            out.carId[at] = hits[i].car == kNoHit ? 0U : scene.world().cars()[hits[i].car].id;
            out.depth_m[at] = hits[i].any() ? hits[i].distance_m * zPerMetre[i] : 0.F;
            const uint32_t h = hash(noise, static_cast<uint32_t>(at));
            const float luma = kImageNoise * gaussian(h);
            for (int c = 0; c < 3; ++c) {
                const float value = toneMap(sum[i][c] / kSamples) + luma +
                                    0.5F * gaussian(hash(h, static_cast<uint32_t>(c)));
                out.rgb[at][static_cast<std::size_t>(c)] =
                    static_cast<uint8_t>(std::clamp(std::lround(value), 0L, 255L));
            }
        }
    }

    RayScene scene;
    unsigned threads;
    std::optional<uint64_t> current;
};

Renderer::Renderer(const World& world, unsigned threads)
    : impl_(std::make_unique<Impl>(world, threads)) {}
Renderer::~Renderer() = default;

RenderedImage Renderer::renderCamera(uint64_t frame, const geometry::StereoCamera& camera,
                                     const SE3& T_vehicle_cam, uint32_t noise_seed) {
    impl_->setFrame(frame);
    RenderedImage out;
    out.width_px = camera.width_px;
    out.height_px = camera.height_px;
    const auto n =
        static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
    out.rgb.resize(n);
    out.carId.resize(n);
    out.depth_m.resize(n);
    const SE3 T_world_cam = impl_->scene.world().T_world_vehicle(frame) * T_vehicle_cam;
    const uint32_t noise =
        hash(impl_->scene.world().options().seed, static_cast<uint32_t>(frame), noise_seed);
    parallelFor(camera.height_px, impl_->threads,
                [&](int v) { impl_->renderRow(v, camera, T_world_cam, noise, out); });
    return out;
}

std::vector<LidarPoint> Renderer::scan(uint64_t frame, const LidarOptions& options) {
    impl_->setFrame(frame);
    constexpr int kBeams = 64;
    const SE3 T_world_velo = impl_->scene.world().T_world_vehicle(frame);
    const auto columns = static_cast<int>(std::lround(360.0 / options.azimuthStep_deg));
    const uint32_t seed =
        hash(impl_->scene.world().options().seed, static_cast<uint32_t>(frame), 900U);
    std::vector<std::vector<LidarPoint>> beams(kBeams);
    parallelFor(kBeams, impl_->threads, [&](int beam) {
        const double elevation = (2.0 - 26.8 * beam / (kBeams - 1)) * M_PI / 180.0;
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
                SurfacePoint s = impl_->scene.surface(rays[i], hits[i], normal);
                s.footprint_m = 0.003F * hits[i].distance_m;
                const float facing = -normal.dot(rays[i].direction);
                const float reflectance = shade(s).reflectance * (0.4F + 0.6F * facing);
                const uint32_t h = hash(seed, static_cast<uint32_t>(beam),
                                        static_cast<uint32_t>(c0) + static_cast<uint32_t>(i));
                // Dark and grazing surfaces lose returns.
                if (unit(hash(h, 7U)) < 0.35F * std::max(0.F, 0.12F - reflectance) / 0.12F)
                    continue;
                const double range = static_cast<double>(hits[i].distance_m) +
                                     options.rangeNoise_m * static_cast<double>(gaussian(h));
                const geometry::Vec3 p = range * d_velo[i];
                beams[static_cast<std::size_t>(beam)].push_back(
                    {static_cast<float>(p.x()), static_cast<float>(p.y()),
                     static_cast<float>(p.z()),
                     std::round(100.F * std::clamp(reflectance, 0.F, 0.99F)) / 100.F});
            }
        }
    });
    std::vector<LidarPoint> out;
    for (const auto& beam : beams) out.insert(out.end(), beam.begin(), beam.end());
    return out;
}

double Renderer::visibleFraction(uint64_t frame, const Car& car, const SE3& T_vehicle_cam) {
    impl_->setFrame(frame);
    const auto& world = impl_->scene.world();
    std::size_t index = 0;
    while (world.cars()[index].id != car.id) ++index;
    const Mesh& mesh = impl_->scene.body(index).mesh;
    const SE3 T_world_obj = world.T_world_obj(car, frame);
    const geometry::Vec3 eye = (world.T_world_vehicle(frame) * T_vehicle_cam).translation();
    std::size_t facing = 0, seen = 0;
    for (std::size_t first = 0; first < mesh.triangles.size(); first += 8) {
        std::array<Ray, 8> rays;
        std::array<bool, 8> active{};
        std::array<Hit, 8> hits;
        for (std::size_t i = 0; i < 8; ++i) {
            rays[i] = {eye.cast<float>(), Vec3f::UnitX()};
            if (first + i >= mesh.triangles.size()) continue;
            const auto& t = mesh.triangles[first + i].vertex;
            const Vec3f a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
            const geometry::Vec3 p = T_world_obj * ((a + b + c) / 3.F).cast<double>().eval();
            const geometry::Vec3 n = T_world_obj.rotation() * (b - a).cross(c - a).cast<double>();
            if (n.norm() < 1e-9 || n.dot(eye - p) <= 0) continue;
            rays[i].direction = (p - eye).normalized().cast<float>();
            active[i] = true;
        }
        impl_->scene.cast(rays, active, hits);
        for (std::size_t i = 0; i < 8; ++i) {
            if (!active[i]) continue;
            ++facing;
            seen += hits[i].car == index ? 1U : 0U;
        }
    }
    return facing == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(facing);
}

}  // namespace djpete::simulator
