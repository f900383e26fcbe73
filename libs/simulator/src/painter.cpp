#include "painter.h"

#include <algorithm>

#include "noise.h"

namespace djpete::simulator {

namespace {

/// Where the sun stands, turned to the left by an angle.
Vec3f sunAt(double turn_rad) {
    const auto c = static_cast<float>(std::cos(turn_rad)),
               s = static_cast<float>(std::sin(turn_rad));
    constexpr float kX = -0.42F, kY = -0.62F;
    return Vec3f(c * kX - s * kY, s * kX + c * kY, 0.74F).normalized();
}

/// Light that comes back from a surface towards the viewer.
Vec3f radiance(const Shade& shade, const Vec3f& n, const Vec3f& view, const Vec3f& sun,
               float sunlight, float open) {
    const float facing = std::max(0.F, n.dot(sun));
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
        const float glint = std::max(0.F, d.dot(sun));
        if (glint > 0.97F)
            c += sunlight * 12.F * shade.gloss * Vec3f::Constant((glint - 0.97F) / 0.03F);
    }
    return c;
}

constexpr float kGrey = 0.55F;  // of fog, and of the sky above it

bool isStreet(Material m) { return m < Material::CarBody; }

/// What is left of a surface's look without texture, marks and panes.
Shade plainShade() {
    Shade out;
    out.albedo = Vec3f::Constant(0.25F);
    return out;
}

/// exp(-x) within 1e-4 for x in 0 .. 0.3, without a call.
float fading(float x) { return 1.F / (1.F + x * (1.F + x * (0.5F + x * (1.F / 6.F)))); }

/// True at an edge that can be seen: another surface, and not nearly the same colour.
bool differ(const Look& a, const Look& b) {
    const float step = 0.06F * std::max(a.inverseDepth, b.inverseDepth);
    if (a.surface == b.surface && std::abs(a.inverseDepth - b.inverseDepth) <= step) return false;
    const float contrast = (a.colour - b.colour).cwiseAbs().maxCoeff();
    // Between leaves there are edges everywhere; only the strong ones are worth more rays.
    const float visible = a.leaf && b.leaf ? 0.30F : 0.14F;
    return contrast > 0.012F + visible * (a.colour + b.colour).maxCoeff();
}

}  // namespace

Painter::Painter(const RayScene& scene)
    : scene_(scene),
      sun_(sunAt(scene.world().options().sunTurn_rad)),
      visibility_m_(static_cast<float>(scene.world().options().visibility_m)),
      plain_(scene.world().options().plain) {}

float Painter::sunlight() const {
    return visibility_m_ > 0 ? std::exp(-60.F / visibility_m_) : 1.F;
}

Vec3f Painter::throughAir(const Vec3f& c, float distance_m) const {
    if (visibility_m_ > 0) {
        const float kept = std::exp(-3.F * distance_m / visibility_m_);
        return kept * c + (1.F - kept) * Vec3f::Constant(kGrey);
    }
    const float haze = 1.F - fading(distance_m / 2200.F);
    return c + haze * (Vec3f(0.66F, 0.74F, 0.82F) - c);
}

Vec3f Painter::skyAt(const Vec3f& direction) const {
    return visibility_m_ > 0 ? Vec3f(Vec3f::Constant(kGrey)) : sky(direction);
}

void Painter::look(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active,
                   float pixelAngle, std::array<Hit, 8>& hits, std::array<Look, 8>& looks) const {
    scene_.cast(rays, active, hits);
    for (const auto& hit : hits)
        if (hit.any()) scene_.prefetch(hit);
    std::array<Ray, 8> toSun;
    std::array<Vec3f, 8> normals;
    std::array<bool, 8> lit{}, blocked{};
    std::array<Shade, 8> shades;
    std::array<float, 8> open;
    open.fill(1.F);
    for (std::size_t i = 0; i < 8; ++i) {
        toSun[i] = {rays[i].origin, sun_};
        if (!active[i] || !hits[i].any()) continue;
        const SurfacePoint s = scene_.surface(rays[i], hits[i], pixelAngle, normals[i]);
        const bool plain = plain_ && isStreet(s.finish.material);
        shades[i] = plain ? plainShade() : shade(s);
        looks[i].leaf = s.finish.material == Material::Leaf;
        if (plain && looks[i].leaf) normals[i] = Vec3f::UnitZ();
        lit[i] = normals[i].dot(sun_) > 0;
        const Vec3f p = rays[i].origin + hits[i].distance_m * rays[i].direction;
        toSun[i].origin = p + shades[i].depth_m * normals[i];
        if (hits[i].thing == kNoHit && normals[i].z() > 0.9F) open[i] = scene_.openness(p);
        looks[i].surface = hash(hits[i].thing, scene_.patch(hits[i]), shades[i].part);
    }
    scene_.occluded(toSun, lit, 150.F, blocked);
    for (std::size_t i = 0; i < 8; ++i) {
        if (!active[i]) continue;
        if (!hits[i].any()) {
            looks[i] = {skyAt(rays[i].direction), 0, 0, false};
            continue;
        }
        const bool sunny = lit[i] && !blocked[i];
        const Vec3f c = radiance(shades[i], normals[i], rays[i].direction, sun_,
                                 sunny ? sunlight() : 0.F, open[i]);
        looks[i].colour = throughAir(c, hits[i].distance_m);
        looks[i].surface += sunny ? 0x51F15EEDU : 0U;
        looks[i].inverseDepth = 1.F / hits[i].distance_m;
    }
}

void Painter::lookAlongRows(int pair, const View& view, std::vector<Look>& looks,
                            RenderedImage& out) const {
    // Packets of four by two pixels stay together longer than eight by one.
    for (int u0 = 0; u0 < view.camera.width_px; u0 += 4) {
        std::array<Ray, 8> rays;
        std::array<float, 8> zPerMetre{};
        std::array<bool, 8> active{};
        std::array<Hit, 8> hits;
        std::array<Look, 8> seen;
        const auto column = [u0](std::size_t i) { return u0 + static_cast<int>(i % 4); };
        const auto row = [pair](std::size_t i) { return 2 * pair + static_cast<int>(i / 4); };
        for (std::size_t i = 0; i < 8; ++i) {
            active[i] = column(i) < view.camera.width_px && row(i) < view.camera.height_px;
            rays[i] =
                view.ray(static_cast<float>(column(i)), static_cast<float>(row(i)), zPerMetre[i]);
        }
        look(rays, active, view.pixelAngle, hits, seen);
        for (std::size_t i = 0; i < 8; ++i) {
            if (!active[i]) continue;
            const std::size_t at = view.at(column(i), row(i));
            looks[at] = seen[i];
            out.actorId[at] =
                hits[i].actor == kNoHit ? 0U : scene_.world().actors()[hits[i].actor].id;
            out.depth_m[at] = hits[i].any() ? hits[i].distance_m * zPerMetre[i] : 0.F;
        }
    }
}

void Painter::smoothEdgesOfRow(int v, const View& view, const std::vector<Look>& looks,
                               std::vector<Vec3f>& colours) const {
    // Beside the centre's ray, two on a diagonal; the diagonals alternate along the row.
    static constexpr float kShift[4][2] = {
        {-0.36F, -0.3F}, {0.36F, 0.3F}, {-0.36F, 0.3F}, {0.36F, -0.3F}};
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
    for (std::size_t first = 0; first < edges.size(); first += 4) {
        std::array<Ray, 8> rays;
        std::array<bool, 8> active{};
        std::array<Hit, 8> hits;
        std::array<Look, 8> seen;
        for (std::size_t i = 0; i < 8; ++i) {
            const std::size_t pixel = first + i / 2;
            active[i] = pixel < edges.size();
            const int u = edges[active[i] ? pixel : first];
            const float* shift = kShift[(static_cast<std::size_t>(u + v) % 2) * 2 + i % 2];
            float unused = 0;
            rays[i] = view.ray(static_cast<float>(u) + shift[0], static_cast<float>(v) + shift[1],
                               unused);
        }
        look(rays, active, view.pixelAngle, hits, seen);
        for (std::size_t i = 0; i < 8 && active[i]; i += 2) {
            Vec3f& colour = colours[view.at(edges[first + i / 2], v)];
            colour = (colour + seen[i].colour + seen[i + 1].colour) * (1.F / 3.F);
        }
    }
}

}  // namespace djpete::simulator
