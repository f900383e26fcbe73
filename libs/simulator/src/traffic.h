/// Who stands, walks and drives on the streets, and where at each frame.
#pragma once

#include <vector>

#include "network.h"
#include "route.h"

namespace djpete::simulator {

/// Where an actor is at one frame, on the plane.
struct Spot {
    double x_m = 0, y_m = 0, yaw_rad = 0;
    float way_m = 0;  ///< walked or driven so far
};

/// The spots of an actor from frame `first` on; a parked one has a single spot for all frames.
struct Track {
    uint64_t first = 0;
    bool parked = true;
    std::vector<Spot> spots;

    bool has(uint64_t frame) const {
        return parked || (frame >= first && frame - first < spots.size());
    }
    const Spot& at(uint64_t frame) const { return parked ? spots.front() : spots[frame - first]; }
};

struct Population {
    std::vector<Actor> actors;
    std::vector<Track> tracks;  ///< of the actor of the same index

    /// Adds an actor without a track; numbers it.
    Actor& add(ActorType type, uint32_t kind, uint32_t seed);
    /// Adds a vehicle of a kind drawn from the seed.
    Actor& addVehicle(uint32_t seed);
    /// Removes actors by index and numbers the others anew.
    void remove(const std::vector<bool>& gone);
};

/// Of what differs between drives through the same streets; without a traffic seed it is the seed.
uint32_t driveSeed(const WorldOptions& options);

/// Cars at both kerbs, with gaps, where they leave room for the own vehicle. With a traffic seed
/// about half of them are gone, or others stand in their places and in gaps.
void parkCars(Population& population, const Network& network, const Route& route,
              const WorldOptions& options);
/// People who walk to and fro on the pavements, or stand.
void addPedestrians(Population& population, const Network& network, const WorldOptions& options,
                    uint64_t frames);
/// Cars before and behind the own vehicle, one that overtakes it, oncoming ones, cyclists, and some
/// that cross its way or turn into it. They keep their distance and give way to the own vehicle,
/// which yields to nobody.
void addTraffic(Population& population, const Network& network, const Route& route,
                const WorldOptions& options);

}  // namespace djpete::simulator
