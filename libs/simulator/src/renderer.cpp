#include <algorithm>
#include <cmath>

#include "noise.h"
#include "parallel.h"
#include "renderer_impl.h"

namespace djpete::simulator {

namespace {

using geometry::SE3;

constexpr float kImageNoise = 1.3F;

const Vec3f& sun() {
    static const Vec3f s = Vec3f(0.62F, 0.50F, 0.78F).normalized();
    return s;
}

/// Scene brightness to 8 bit: exposure, gamma 2.2, and the deep blacks of KITTI's cameras.
float toneMap(float linear) {
    static const std::vector<float> table = [] {
        std::vector<float> t(4097);
        for (std::size_t i = 0; i < t.size(); ++i) {
            const float bright = std::pow(static_cast<float>(i) / 4096.F, 1.F / 2.2F);
            t[i] = 255.F * std::max(0.F, 1.16F * (bright - 0.13F) - 0.01F);
        }
        return t;
    }();
    const float x = std::clamp(1.3F * linear, 0.F, 1.F) * 4095.F;
    const auto i = static_cast<std::size_t>(x);
    return table[i] + (x - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

/// Light that comes back from a surface towards the viewer.
Vec3f radiance(const Shade& shade, const Vec3f& n, const Vec3f& view, float sunlight, float open) {
    const float facing = std::max(0.F, n.dot(sun()));
    const Vec3f skylight = (0.5F + 0.5F * n.z()) * Vec3f(0.19F, 0.215F, 0.26F);
    const Vec3f bounce =
        (0.5F - 0.5F * n.z()) * Vec3f(0.13F, 0.122F, 0.11F) + Vec3f::Constant(0.025F);
    Vec3f c = shade.albedo.cwiseProduct(open * (skylight + bounce) +
                                        sunlight * facing * Vec3f(1.42F, 1.33F, 1.17F));
    if (shade.gloss > 0) {
        const float cosine = -view.dot(n);
        const Vec3f d = view + 2.F * cosine * n;
        const float graze = 1.F - std::clamp(cosine, 0.F, 1.F), g2 = graze * graze;
        c += (shade.gloss + 0.5F * g2 * g2 * graze) * mirrored(d);
        const float glint = std::max(0.F, d.dot(sun()));
        if (glint > 0.97F)
            c += sunlight * 12.F * shade.gloss * Vec3f::Constant((glint - 0.97F) / 0.03F);
    }
    return c;
}

/// One camera at one frame.
struct View {
    const geometry::StereoCamera& camera;
    Eigen::Matrix3f R_world_cam;
    Vec3f origin;
    float pixelAngle;

    View(const geometry::StereoCamera& c, const SE3& T_world_cam)
        : camera(c),
          R_world_cam(T_world_cam.rotation().cast<float>()),
          origin(T_world_cam.translation().cast<float>()),
          pixelAngle(static_cast<float>(1.0 / c.fx)) {}
    /// Ray through a pixel; `zPerMetre`: depth gained per metre along it.
    Ray ray(float u, float v, float& zPerMetre) const {
        const Vec3f d((u - static_cast<float>(camera.cx)) / static_cast<float>(camera.fx),
                      (v - static_cast<float>(camera.cy)) / static_cast<float>(camera.fy), 1.F);
        zPerMetre = 1.F / d.norm();
        return {origin, R_world_cam * (zPerMetre * d)};
    }
    std::size_t at(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width_px) +
               static_cast<std::size_t>(u);
    }
};

/// The steps from rays to a picture.
struct Painter {
    const RayScene& scene;

    /// Traces, lights and shades eight rays.
    void look(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active, float pixelAngle,
              std::array<Hit, 8>& hits, std::array<Look, 8>& looks) const {
        scene.cast(rays, active, hits);
        std::array<Ray, 8> toSun;
        std::array<Vec3f, 8> normals;
        std::array<bool, 8> lit{}, blocked{};
        std::array<Shade, 8> shades;
        std::array<float, 8> open;
        open.fill(1.F);
        for (std::size_t i = 0; i < 8; ++i) {
            toSun[i] = {rays[i].origin, sun()};
            if (!active[i] || !hits[i].any()) continue;
            const SurfacePoint s = scene.surface(rays[i], hits[i], pixelAngle, normals[i]);
            shades[i] = shade(s);
            lit[i] = normals[i].dot(sun()) > 0;
            const Vec3f p = rays[i].origin + hits[i].distance_m * rays[i].direction;
            toSun[i].origin = p + shades[i].depth_m * normals[i];
            if (p.z() < 0.2F && normals[i].z() > 0.9F) open[i] = scene.openness(p);
            looks[i].surface = hash(hits[i].thing, scene.triangle(hits[i]).patch, shades[i].part);
        }
        scene.occluded(toSun, lit, 150.F, blocked);
        for (std::size_t i = 0; i < 8; ++i) {
            if (!active[i]) continue;
            if (!hits[i].any()) {
                looks[i] = {sky(rays[i].direction), 0, 0};
                continue;
            }
            const bool sunny = lit[i] && !blocked[i];
            const Vec3f c =
                radiance(shades[i], normals[i], rays[i].direction, sunny ? 1.F : 0.F, open[i]);
            const float haze = 1.F - std::exp(-hits[i].distance_m / 2200.F);
            looks[i].colour = c + haze * (Vec3f(0.66F, 0.74F, 0.82F) - c);
            looks[i].surface += sunny ? 0x51F15EEDU : 0U;
            looks[i].inverseDepth = 1.F / hits[i].distance_m;
        }
    }

    /// A ray through every pixel centre of a row: colour and truth.
    void lookAlongRow(int v, const View& view, std::vector<Look>& looks, RenderedImage& out) const {
        for (int u0 = 0; u0 < view.camera.width_px; u0 += 8) {
            std::array<Ray, 8> rays;
            std::array<float, 8> zPerMetre{};
            std::array<bool, 8> active{};
            std::array<Hit, 8> hits;
            std::array<Look, 8> seen;
            for (std::size_t i = 0; i < 8; ++i) {
                const int u = u0 + static_cast<int>(i);
                active[i] = u < view.camera.width_px;
                rays[i] = view.ray(static_cast<float>(u), static_cast<float>(v), zPerMetre[i]);
            }
            look(rays, active, view.pixelAngle, hits, seen);
            for (std::size_t i = 0; i < 8 && active[i]; ++i) {
                const std::size_t at = view.at(u0, v) + i;
                looks[at] = seen[i];
                out.actorId[at] =
                    hits[i].actor == kNoHit ? 0U : scene.world().actors()[hits[i].actor].id;
                out.depth_m[at] = hits[i].any() ? hits[i].distance_m * zPerMetre[i] : 0.F;
            }
        }
    }

    /// True at an edge that can be seen: another surface, and not nearly the same colour.
    static bool differ(const Look& a, const Look& b) {
        const float step = 0.06F * std::max(a.inverseDepth, b.inverseDepth);
        if (a.surface == b.surface && std::abs(a.inverseDepth - b.inverseDepth) <= step)
            return false;
        const float contrast = (a.colour - b.colour).cwiseAbs().maxCoeff();
        return contrast > 0.012F + 0.09F * (a.colour + b.colour).maxCoeff();
    }

    /// Pixels with an edge to a neighbour get the mean of four rays; two of them per packet.
    void smoothEdgesOfRow(int v, const View& view, const std::vector<Look>& looks,
                          std::vector<Vec3f>& colours) const {
        static constexpr float kShift[4][2] = {
            {-0.125F, -0.375F}, {0.375F, -0.125F}, {-0.375F, 0.125F}, {0.125F, 0.375F}};
        const int w = view.camera.width_px, h = view.camera.height_px;
        std::vector<int> edges;
        for (int u = 0; u < w; ++u) {
            const std::size_t at = view.at(u, v);
            const auto step = static_cast<std::size_t>(w);
            colours[at] = looks[at].colour;
            if ((u > 0 && differ(looks[at], looks[at - 1])) ||
                (u + 1 < w && differ(looks[at], looks[at + 1])) ||
                (v > 0 && differ(looks[at], looks[at - step])) ||
                (v + 1 < h && differ(looks[at], looks[at + step])))
                edges.push_back(u);
        }
        for (std::size_t first = 0; first < edges.size(); first += 2) {
            std::array<Ray, 8> rays;
            std::array<bool, 8> active{};
            std::array<Hit, 8> hits;
            std::array<Look, 8> seen;
            for (std::size_t i = 0; i < 8; ++i) {
                const std::size_t pixel = first + i / 4;
                active[i] = pixel < edges.size();
                const auto u = static_cast<float>(edges[active[i] ? pixel : first]);
                float unused = 0;
                rays[i] = view.ray(u + kShift[i % 4][0], static_cast<float>(v) + kShift[i % 4][1],
                                   unused);
            }
            look(rays, active, view.pixelAngle, hits, seen);
            for (std::size_t i = 0; i < 8 && active[i]; i += 4)
                colours[view.at(edges[first + i / 4], v)] =
                    0.25F *
                    (seen[i].colour + seen[i + 1].colour + seen[i + 2].colour + seen[i + 3].colour);
        }
    }

    /// Noise and quantisation.
    static void developRow(int v, const View& view, const std::vector<Vec3f>& colours,
                           uint32_t noise, RenderedImage& out) {
        for (int u = 0; u < view.camera.width_px; ++u) {
            const std::size_t at = view.at(u, v);
            const uint32_t h = hash(noise, static_cast<uint32_t>(at));
            const float luma = kImageNoise * gaussian(h);
            for (int c = 0; c < 3; ++c) {
                const float value = toneMap(colours[at][c]) + luma +
                                    0.7F * gaussian(hash(h, static_cast<uint32_t>(c)));
                out.rgb[at][static_cast<std::size_t>(c)] =
                    static_cast<uint8_t>(std::clamp(value + 0.5F, 0.F, 255.F));
            }
        }
    }
};

}  // namespace

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
    out.actorId.resize(n);
    out.depth_m.resize(n);
    const View view(camera, impl_->scene.world().T_world_vehicle(frame) * T_vehicle_cam);
    const uint32_t noise =
        hash(impl_->scene.world().options().seed, static_cast<uint32_t>(frame), noise_seed);
    auto& looks = impl_->looks;
    auto& colours = impl_->colours;
    looks.resize(n);
    colours.resize(n);
    const Painter painter{impl_->scene};
    parallelFor(camera.height_px, impl_->threads,
                [&](int v) { painter.lookAlongRow(v, view, looks, out); });
    parallelFor(camera.height_px, impl_->threads, [&](int v) {
        painter.smoothEdgesOfRow(v, view, looks, colours);
        Painter::developRow(v, view, colours, noise, out);
    });
    return out;
}

}  // namespace djpete::simulator
