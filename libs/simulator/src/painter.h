/// From rays to the light that reaches a camera's pixels.
#pragma once

#include <cmath>

#include "djpete/simulator/renderer.h"
#include "ray_scene.h"

namespace djpete::simulator {

/// What a ray saw.
struct Look {
    Vec3f colour = Vec3f::Zero();
    uint32_t surface = 0;  ///< differs between neighbours where there is an edge
    float inverseDepth = 0;
    bool leaf = false;
};

/// One camera at one frame.
struct View {
    const geometry::StereoCamera& camera;
    Eigen::Matrix3f R_world_cam;
    Vec3f origin;
    float pixelAngle;

    View(const geometry::StereoCamera& c, const geometry::SE3& T_world_cam)
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

/// The steps from rays to light per pixel.
class Painter {
  public:
    explicit Painter(const RayScene& scene);

    /// Traces, lights and shades eight rays.
    void look(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active, float pixelAngle,
              std::array<Hit, 8>& hits, std::array<Look, 8>& looks) const;
    /// A ray through every pixel centre of rows 2 * pair and 2 * pair + 1: light and truth.
    void lookAlongRows(int pair, const View& view, std::vector<Look>& looks,
                       RenderedImage& out) const;
    /// The light of a row's pixels: those with an edge to a neighbour get the mean of three rays.
    void smoothEdgesOfRow(int v, const View& view, const std::vector<Look>& looks,
                          std::vector<Vec3f>& colours) const;

  private:
    /// Share of the sun's light that comes through the fog.
    float sunlight() const;
    /// Light after its way through haze or fog.
    Vec3f throughAir(const Vec3f& c, float distance_m) const;
    Vec3f skyAt(const Vec3f& direction) const;

    const RayScene& scene_;
    Vec3f sun_;           ///< direction towards it
    float visibility_m_;  ///< in fog; 0: clear air
    bool plain_;          ///< streets without texture
};

}  // namespace djpete::simulator
