/// Streets with parked and moving cars and people, and a rig that drives through it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/cuboid.h"
#include "djpete/geometry/se3.h"
#include "djpete/simulator/street.h"

namespace djpete::simulator {

/// Where a drive without given poses leads.
enum class RouteKind {
    Street,  ///< along a gently bending street, never back
    Blocks   ///< round city blocks, again and again: loops to close
};

struct WorldOptions {
    uint32_t seed = 1;
    /// How long the drive lasts. Shorter drives see the same world; with a traffic seed, a lane
    /// offset or a convoy some actors may differ.
    uint64_t frames = 100;
    double step_m = 0.8;    ///< way of the own vehicle per frame, in bends less
    double period_s = 0.1;  ///< between frames
    RouteKind route = RouteKind::Street;
    /// Another number: other moving vehicles, people and sensor noise, and about half of the parked
    /// cars, on the same streets. 0: those that belong to the seed.
    uint32_t trafficSeed = 0;
    double laneOffset_m = 0;  ///< the own vehicle keeps this far to the left of the way
    /// If above 0, vehicles drive with the own one, so near that they cover about this share of the
    /// left image, up to 0.5. Parked cars and people that they would touch are not there.
    double convoyShare = 0;
    double sunTurn_rad = 0;  ///< the sun stands this far to the left of its usual place
    /// If above 0, cameras see through fog of this meteorological visibility (contrast falls to 5 %
    /// over it), and the sun only as far as it comes through 20 m of it. The LiDAR sees as ever.
    double visibility_m = 0;
    /// Streets, houses and plants in one grey without texture, marks or panes; vehicles and people
    /// look as ever.
    bool plain = false;
    /// If not empty, the way is these poses of the left camera, seen from the first one, as KITTI
    /// gives them, and `frames` and `step_m` have no meaning: the street is built along them.
    /// The height is smoothed, so that the vehicle stays on the ground where the way comes back.
    std::vector<geometry::SE3> T_first_cam;
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
    bool moving = false;             ///< not parked
};

class Network;
struct Route;
struct Track;

/// Everything that is true of a drive. Frame `world` of the simulator: ground at z = 0.
class World {
  public:
    /// Throws std::runtime_error if the poses of the options lead nowhere.
    explicit World(const WorldOptions& options);
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    const WorldOptions& options() const { return options_; }
    /// Number of frames there are.
    uint64_t frames() const;
    /// Streets and ground.
    const Network& network() const { return *network_; }
    const Route& route() const { return *route_; }
    const std::vector<Actor>& actors() const { return actors_; }

    /// False before a moving actor enters the street and after it has left it.
    bool present(const Actor& actor, uint64_t frame) const;
    /// Box centre of an actor at a frame at which it is present.
    geometry::SE3 T_world_obj(const Actor& actor, uint64_t frame) const;
    /// Which of its body's shapes an actor has at a frame: people walk in kGaitPhases steps, all
    /// else has one shape.
    uint32_t phase(const Actor& actor, uint64_t frame) const;
    /// The own vehicle (frame velo, 1.73 m above ground), with a little pitch and bounce; of
    /// frames up to frames() + 1, the last of them standing for all that follow.
    geometry::SE3 T_world_vehicle(uint64_t frame) const;
    /// The own vehicle at frame 0 if it had no lane offset: the world of the files, so that drives
    /// with different offsets share it.
    const geometry::SE3& T_world_start() const;
    /// Of traffic and sensor noise: another one for each seed and traffic seed.
    uint32_t driveSeed() const;

  private:
    WorldOptions options_;
    std::unique_ptr<const Route> route_;
    std::unique_ptr<const Network> network_;
    std::vector<Actor> actors_;
    std::vector<Track> tracks_;  // of the actor of the same index
};

/// KITTI's rig: left camera on the vehicle, and the camera scaled to an image size.
geometry::SE3 T_vehicle_camera();
geometry::StereoCamera rigCamera(int width_px, int height_px);

}  // namespace djpete::simulator
