#include <algorithm>
#include <cmath>

#include "development.h"
#include "parallel.h"

namespace djpete::simulator {

namespace {

/// colours = the kernel's sum over colours `step` apart, along lines of `length` pixels.
void blurLines(const std::vector<float>& half, int lines, int lineStep, int length, int step,
               unsigned threads, const std::vector<Vec3f>& from, std::vector<Vec3f>& to) {
    parallelFor(lines, threads, [&](int line) {
        const auto at = [&](int i) {
            return static_cast<std::size_t>(line) * static_cast<std::size_t>(lineStep) +
                   static_cast<std::size_t>(std::clamp(i, 0, length - 1)) *
                       static_cast<std::size_t>(step);
        };
        for (int i = 0; i < length; ++i) {
            Vec3f sum = half[0] * from[at(i)];
            for (int k = 1; k < static_cast<int>(half.size()); ++k)
                sum += half[static_cast<std::size_t>(k)] * (from[at(i - k)] + from[at(i + k)]);
            to[at(i)] = sum;
        }
    });
}

}  // namespace

void blurLight(float sigma_px, int width, int height, unsigned threads,
               std::vector<Vec3f>& colours) {
    const int reach = std::max(1, static_cast<int>(std::ceil(2.5F * sigma_px)));
    std::vector<float> half;
    float sum = 0;
    for (int k = 0; k <= reach; ++k) {
        const float x = static_cast<float>(k) / sigma_px;
        half.push_back(std::exp(-0.5F * x * x));
        sum += (k == 0 ? 1.F : 2.F) * half.back();
    }
    for (float& h : half) h /= sum;
    std::vector<Vec3f> along(colours.size());
    blurLines(half, height, width, width, 1, threads, colours, along);
    blurLines(half, width, 1, height, width, threads, along, colours);
}

void blurByMotion(const geometry::StereoCamera& camera, const geometry::SE3& T_end_begin,
                  const std::vector<float>& depth_m, unsigned threads,
                  std::vector<Vec3f>& colours) {
    constexpr double kSky_m = 1e4, kNear_m = 0.5;
    constexpr int kMostTaps = 9;
    const std::vector<Vec3f> sharp = colours;
    const int w = camera.width_px, h = camera.height_px;
    const auto index = [w](int u, int v) {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(w) +
               static_cast<std::size_t>(u);
    };
    parallelFor(h, threads, [&](int v) {
        for (int u = 0; u < w; ++u) {
            const float z = depth_m[index(u, v)];
            const geometry::Vec3 p =
                T_end_begin * camera.backProject({u, v}, z > 0 ? static_cast<double>(z) : kSky_m);
            if (p.z() < kNear_m) continue;
            const geometry::Vec2 way = camera.project(p) - geometry::Vec2(u, v);
            // As many taps as pixels on the way, an odd number.
            const int side = std::min(kMostTaps / 2, static_cast<int>(0.5 * way.norm() + 0.5));
            if (side == 0) continue;
            Vec3f sum = sharp[index(u, v)];
            for (int k = -side; k <= side; ++k) {
                if (k == 0) continue;
                const double f = static_cast<double>(k) / (2 * side + 1);
                const int x = std::clamp(static_cast<int>(std::lround(u + f * way.x())), 0, w - 1);
                const int y = std::clamp(static_cast<int>(std::lround(v + f * way.y())), 0, h - 1);
                sum += sharp[index(x, y)];
            }
            colours[index(u, v)] = sum / static_cast<float>(2 * side + 1);
        }
    });
}

}  // namespace djpete::simulator
