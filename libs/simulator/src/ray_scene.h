/// The world as Embree sees it at one frame.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <optional>
#include <vector>

#include "actor_body.h"
#include "djpete/simulator/world.h"
#include "facets.h"
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

/// Street, plants and actors in one ray-tracing scene; actors are instances that move with the
/// frame. Shapes of actors are made when they first come near.
class RayScene {
  public:
    static constexpr double kReach_m = 220;

    explicit RayScene(const World& world);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Puts every actor where it is at `frame`; those farther than kReach_m from the own vehicle
    /// are left out. Not while rays are cast.
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
    /// Asks for the memory that surface() and patch() of a hit will need.
    void prefetch(const Hit& hit) const {
        const auto* f = reinterpret_cast<const char*>(&facet(hit));
        __builtin_prefetch(f);
        __builtin_prefetch(f + 64);
    }
    /// The smooth surface of a hit: Triangle::patch.
    uint32_t patch(const Hit& hit) const { return facet(hit).patch; }
    /// 1: open ground, towards 0: under a car. For points on the ground.
    float openness(const Vec3f& p_world) const;
    /// The present shape of an actor.
    const CarBody& body(std::size_t actor);
    const World& world() const { return world_; }

  private:
    /// Triangles to be hit and how they look.
    struct Shape {
        RTCScene scene = nullptr;
        std::vector<Facet> facets;
        const Mesh* mesh = nullptr;
    };
    /// One shape of an actor; empty until it is needed.
    struct ActorShape {
        std::optional<CarBody> body;
        Shape shape;
    };
    /// A shape that occurs in the scene at a place.
    struct Thing {
        const Shape* shape = nullptr;
        const CarBody* body = nullptr;  ///< of actors
        Eigen::Matrix3f R_world_obj = Eigen::Matrix3f::Identity();
    };
    static constexpr int kCells = 32;  // of the grid of cars around the own vehicle
    static constexpr float kCell_m = 6.F;

    Shape newShape(const Mesh& mesh);
    void addInstance(const Shape* shape);
    void addPlants();
    void placeActor(std::size_t actor, uint64_t frame);
    void placeCars(uint64_t frame);
    /// Far plants get coarser leaves.
    void placePlants(uint64_t frame);
    ActorShape& shapeOf(std::size_t actor);
    const Shape& shape(const Hit& hit) const {
        return hit.thing == kNoHit ? streetShape_ : *things_[hit.thing].shape;
    }
    const Facet& facet(const Hit& hit) const { return shape(hit).facets[hit.triangle]; }

    const World& world_;
    StreetModel street_;
    Shape streetShape_;
    std::vector<Shape> plantShapes_, coarsePlantShapes_;
    std::vector<std::vector<ActorShape>> actorShapes_;  // per actor and phase
    std::vector<uint32_t> phase_;                       // shape at the present frame
    std::vector<bool> shown_;                           // actor is in the scene
    std::vector<geometry::SE3> T_world_obj_;            // of the actors shown
    std::vector<Thing> things_;  // actors first, then plants; geometry id of thing i is i + 1
    Vec3f gridCorner_ = Vec3f::Zero();
    std::vector<std::vector<uint32_t>> carsNear_;  // per grid cell
    RTCDevice device_;
    RTCScene scene_;
    RTCScene empty_;  // stands for the shape of an actor that was never near
    std::vector<RTCGeometry> instances_;
};

}  // namespace djpete::simulator
