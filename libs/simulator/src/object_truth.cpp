#include "djpete/simulator/object_truth.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "actor_body.h"
#include "materials.h"
#include "processor.h"

namespace djpete::simulator {
namespace {

uint8_t srgbOf(float linear) {
    const float x = std::clamp(linear, 0.F, 1.F);
    const float coded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.F / 2.4F) - 0.055F;
    return static_cast<uint8_t>(255.F * coded + 0.5F);
}

std::array<float, 3> arrayOf(const Vec3f& v) { return {v.x(), v.y(), v.z()}; }

/// Splits a body's triangles. An edge is always halved at its middle, by both of its triangles, so
/// that no gaps open.
class Splitter {
  public:
    Splitter(const CarBody& body, float texel_m)
        : body_(body), mesh_(body.mesh), texel_m_(texel_m) {}

    ColouredMesh split() {
        // A vertex is shared within one smooth surface of one finish.
        std::unordered_map<uint64_t, uint32_t> corners;  // only looked up
        uint32_t surface = 0;
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const Triangle& t = mesh_.triangles[i];
            if (i > 0 && (t.patch != mesh_.triangles[i - 1].patch ||
                          t.finish != mesh_.triangles[i - 1].finish)) {
                ++surface;
                middles_.clear();
            }
            const Vec3f flat = flatNormal(t);
            if (flat.norm() < 1e-12F) continue;  // no area
            std::array<uint32_t, 3> corner{};
            for (std::size_t k = 0; k < 3; ++k) {
                const uint32_t v = t.vertex[k];
                const auto [at, fresh] = corners.try_emplace(
                    (static_cast<uint64_t>(surface) << 32U) | v, uint32_t(points_.size()));
                if (fresh) addPoint(v, flat.normalized());
                corner[k] = at->second;
            }
            cut(corner, mesh_.finishes[t.finish]);
        }
        return std::move(out_);
    }

  private:
    struct Point {
        Vec3f p, n;
        Vec2f uv;
    };

    Vec3f flatNormal(const Triangle& t) const {
        const Vec3f& a = mesh_.vertices[t.vertex[0]];
        return (mesh_.vertices[t.vertex[1]] - a).cross(mesh_.vertices[t.vertex[2]] - a);
    }
    void addPoint(uint32_t v, const Vec3f& flat) {
        const Vec3f n = mesh_.normals[v];
        points_.push_back({mesh_.vertices[v], n.norm() < 0.1F ? flat : n, mesh_.uv[v]});
        out_.vertices.emplace_back();
        done_.push_back(false);
    }
    uint32_t middleOf(uint32_t a, uint32_t b) {
        const uint64_t key = (static_cast<uint64_t>(std::min(a, b)) << 32U) | std::max(a, b);
        const auto [at, fresh] = middles_.try_emplace(key, uint32_t(points_.size()));
        if (fresh) {
            const Point &p = points_[a], &q = points_[b];
            points_.push_back({0.5F * (p.p + q.p), 0.5F * (p.n + q.n), 0.5F * (p.uv + q.uv)});
            out_.vertices.emplace_back();
            done_.push_back(false);
        }
        return at->second;
    }
    void cut(const std::array<uint32_t, 3>& t, const Finish& finish) {
        std::size_t longest = 0;
        float length = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float l = (points_[t[k]].p - points_[t[(k + 1) % 3]].p).norm();
            if (l > length) length = l, longest = k;
        }
        const uint32_t a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
        if (length > texel_m_) {
            const uint32_t m = middleOf(a, b);
            cut({a, m, c}, finish);
            cut({m, b, c}, finish);
            return;
        }
        for (uint32_t i : t) colour(i, finish);
        out_.triangles.push_back(t);
    }
    void colour(uint32_t i, const Finish& finish) {
        if (done_[i]) return;
        done_[i] = true;
        const Point& p = points_[i];
        SurfacePoint s;
        s.finish = finish;
        s.uv = p.uv;
        s.p_obj = p.p;
        s.n_obj = p.n.normalized();
        s.car = &body_;
        s.footprint_m = texel_m_;
        s.major_m = Vec2f(texel_m_, 0);
        auto& v = out_.vertices[i];
        v.p_obj = arrayOf(p.p);
        v.n_obj = arrayOf(s.n_obj);
        v.albedo = arrayOf(shade(s).albedo.cwiseMax(0.F).cwiseMin(1.F));
        std::transform(v.albedo.begin(), v.albedo.end(), v.srgb.begin(), srgbOf);
    }

    const CarBody& body_;
    const Mesh& mesh_;
    const float texel_m_;
    std::vector<Point> points_;
    std::vector<bool> done_;
    std::unordered_map<uint64_t, uint32_t> middles_;  // of this surface; only looked up
    ColouredMesh out_;
};

/// Appends the bytes of a number, the lowest first.
template <class T>
void append(std::string& out, T value) {
    uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i)
        out.push_back(static_cast<char>((bits >> (8U * i)) & 0xFFU));
}

}  // namespace

ColouredMesh objectTruth(const Actor& actor, double texel_m, uint32_t phase) {
    requireAvx2();
    if (!(texel_m >= 0.001))
        throw std::runtime_error("A texel of " + std::to_string(texel_m) +
                                 " m is too small: at least 0.001 m is expected");
    const CarBody body = makeBody(actor, phase);
    return Splitter(body, static_cast<float>(texel_m)).split();
}

void writePly(const ColouredMesh& mesh, const std::filesystem::path& path) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\ncomment frame obj: box centre; x front, y left, z "
        "up; metres; albedo as sRGB\nelement vertex " +
        std::to_string(mesh.vertices.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float "
        "ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar "
        "blue\nelement face " +
        std::to_string(mesh.triangles.size()) +
        "\nproperty list uchar int vertex_indices\nend_header\n";
    bytes.reserve(bytes.size() + 27 * mesh.vertices.size() + 13 * mesh.triangles.size());
    for (const auto& v : mesh.vertices) {
        for (float x : v.p_obj) append(bytes, x);
        for (float x : v.n_obj) append(bytes, x);
        for (uint8_t c : v.srgb) append(bytes, c);
    }
    for (const auto& t : mesh.triangles) {
        append(bytes, uint8_t{3});
        for (uint32_t i : t) append(bytes, i);
    }
    std::ofstream out(path, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throw std::runtime_error("Cannot write " + path.string());
}

}  // namespace djpete::simulator
