/// A street with parked and moving cars, and a rig that drives through it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/cuboid.h"
#include "djpete/geometry/se3.h"
#include "djpete/simulator/street.h"

namespace djpete::simulator {

struct WorldOptions {
    uint32_t seed = 1;
    uint64_t frames = 100;  ///< how long the street must be; it grows in steps of a kilometre, so
                            ///< that shorter drives see the same world
    double step_m = 0.8;    ///< way of the own vehicle per frame
    double period_s = 0.1;  ///< between frames
};

/// What an actor is; the names are KITTI's.
enum class ActorType : uint8_t { Car, Van, Truck, Pedestrian, Cyclist };
const char* nameOf(ActorType type);

/// A car or a person. Its number is its track id in labels and masks.
struct Actor {
    uint32_t id = 0;
    ActorType type = ActorType::Car;
    uint32_t kind = 0;               ///< body of its type
    uint32_t seed = 0;               ///< paint and details
    geometry::Vec3 size_m{0, 0, 0};  ///< exact box of its mesh (length, width, height)
    bool moving = false;
    // Parked or driving on a lane: position along the street, offset to the left, speed along it.
    double s0_m = 0, lateral_m = 0, speed_mps = 0;
    bool oncoming = false;  ///< faces against the street's direction
};

/// Everything that is true of a drive. Frame `world` of the simulator: ground at z = 0.
class World {
  public:
    /// Throws std::runtime_error if the street has more cars than KITTI's masks can tell apart.
    explicit World(const WorldOptions& options);

    const WorldOptions& options() const { return options_; }
    const Street& street() const { return street_; }
    const std::vector<Actor>& actors() const { return actors_; }

    /// False before a moving actor enters the street and after it has left it.
    bool present(const Actor& actor, uint64_t frame) const;
    /// Box centre of an actor at a frame at which it is present.
    geometry::SE3 T_world_obj(const Actor& actor, uint64_t frame) const;
    /// Which of its body's shapes an actor has at a frame: people walk in kGaitPhases steps, all
    /// else has one shape.
    uint32_t phase(const Actor& actor, uint64_t frame) const;
    /// The own vehicle (frame velo, 1.73 m above ground), with a little pitch and bounce.
    geometry::SE3 T_world_vehicle(uint64_t frame) const;

  private:
    void park();
    void addTraffic();

    WorldOptions options_;
    Street street_;
    std::vector<Actor> actors_;
};

/// KITTI's rig: left camera on the vehicle, and the camera scaled to an image size.
geometry::SE3 T_vehicle_camera();
geometry::StereoCamera rigCamera(int width_px, int height_px);

}  // namespace djpete::simulator
