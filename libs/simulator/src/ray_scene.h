/// The world as Embree sees it at one frame.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <vector>

#include "car_body.h"
#include "djpete/simulator/world.h"
#include "materials.h"

namespace djpete::simulator {

constexpr uint32_t kNoHit = RTC_INVALID_GEOMETRY_ID;

struct Ray {
    Vec3f origin, direction;  ///< world; direction of unit length
};
struct Hit {
    float distance_m = 0;
    uint32_t triangle = kNoHit;  ///< kNoHit: the sky
    uint32_t car = kNoHit;       ///< index into World::cars(), or kNoHit for the street
    float u = 0, v = 0;          ///< barycentric
    bool any() const { return triangle != kNoHit; }
};

/// Street and car meshes in one ray-tracing scene; cars are instances that move with the frame.
class RayScene {
  public:
    explicit RayScene(const World& world);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Puts every car where it is at `frame`. Not while rays are cast.
    void setFrame(uint64_t frame);

    /// Eight rays at once; unused ones have `active[i]` false. Thread-safe.
    void cast(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active,
              std::array<Hit, 8>& hits) const;
    /// True per ray if something lies between its origin and `reach_m`. Thread-safe.
    void occluded(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active, float reach_m,
                  std::array<bool, 8>& blocked) const;

    /// What the ray met: surface for shading, and its normal in the world towards the viewer.
    SurfacePoint surface(const Ray& ray, const Hit& hit, Vec3f& normal_world) const;
    const CarBody& body(std::size_t car) const { return bodies_[car]; }
    const World& world() const { return world_; }

  private:
    RTCGeometry addMesh(RTCScene scene, const Mesh& mesh);

    const World& world_;
    Mesh street_;
    std::vector<CarBody> bodies_;
    std::vector<geometry::SE3> T_world_obj_;
    RTCDevice device_;
    RTCScene scene_;
    std::vector<RTCScene> carScenes_;
    std::vector<RTCGeometry> instances_;
};

}  // namespace djpete::simulator
