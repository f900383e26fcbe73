/// The world as Embree sees it at one frame.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <vector>

#include "actor_body.h"
#include "djpete/simulator/world.h"
#include "materials.h"
#include "street_builder.h"

namespace djpete::simulator {

constexpr uint32_t kNoHit = RTC_INVALID_GEOMETRY_ID;

struct Ray {
    Vec3f origin, direction;  ///< world; direction of unit length
};
struct Hit {
    float distance_m = 0;
    uint32_t triangle = kNoHit;  ///< kNoHit: the sky
    uint32_t thing = kNoHit;     ///< actor or plant, or kNoHit for the street
    uint32_t actor = kNoHit;     ///< index into World::actors(), or kNoHit
    float u = 0, v = 0;          ///< barycentric
    bool any() const { return triangle != kNoHit; }
};

/// Street, plants and cars in one ray-tracing scene; cars are instances that move with the frame.
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
    /// `pixelAngle` (rad) sets the footprint.
    SurfacePoint surface(const Ray& ray, const Hit& hit, float pixelAngle,
                         Vec3f& normal_world) const;
    /// The triangle of a hit.
    const Triangle& triangle(const Hit& hit) const;
    /// 1: open ground, towards 0: under a car. For points on the ground.
    float openness(const Vec3f& p_world) const;
    const CarBody& body(std::size_t actor) const { return bodies_[actor][phase_[actor]]; }
    const World& world() const { return world_; }

  private:
    /// A mesh that occurs in the scene at a place.
    struct Thing {
        const Mesh* mesh = nullptr;
        Eigen::Matrix3f R_world_obj = Eigen::Matrix3f::Identity();
    };
    static constexpr int kCells = 32;  // of the grid of cars around the own vehicle
    static constexpr float kCell_m = 6.F;

    RTCScene newMeshScene(const Mesh& mesh);
    void addInstance(RTCScene scene, const Mesh& mesh);
    void addPlants();
    void placeCars(uint64_t frame);
    const Mesh& meshOf(const Hit& hit) const;

    const World& world_;
    StreetModel street_;
    std::vector<std::vector<CarBody>> bodies_;  // per actor: its shapes
    std::vector<std::vector<RTCScene>> bodyScenes_;
    std::vector<uint32_t> phase_;  // shape at the present frame
    std::vector<geometry::SE3> T_world_obj_;
    std::vector<Thing> things_;  // actors first, then plants; geometry id of thing i is i + 1
    Vec3f gridCorner_ = Vec3f::Zero();
    std::vector<std::vector<uint32_t>> carsNear_;  // per grid cell
    RTCDevice device_;
    RTCScene scene_;
    std::vector<RTCScene> meshScenes_;
    std::vector<RTCGeometry> instances_;
};

}  // namespace djpete::simulator
