/// Vehicles that drive with the own one and fill a share of its image.
#pragma once

#include <vector>

#include "traffic.h"

namespace djpete::simulator {

/// A place beside or before the own vehicle, and who keeps it.
struct ConvoyPlace {
    ActorType type = ActorType::Van;
    uint32_t kind = 0, seed = 0;
    geometry::Vec3 size_m{0, 0, 0};
    double ahead_m = 0;  ///< its middle along the way, from the own vehicle's
    double left_m = 0;   ///< of the way
};

/// Places that cover about WorldOptions::convoyShare of the left image on the mean over the way
/// (over the frames where poses are given): one in the own lane, 7 to 10 m before the camera, and
/// up to two in the lane to the left. Nobody touches anybody on the way. Where the share cannot be
/// reached it is missed as little as can be; empty for a share of 0. Throws std::runtime_error if
/// nobody fits on the way.
std::vector<ConvoyPlace> planConvoy(const Route& route, const WorldOptions& options);

/// Adds the vehicles, which keep their places with a little sway. Returns their indices.
std::vector<std::size_t> addConvoy(Population& population, const std::vector<ConvoyPlace>& places,
                                   const Route& route, const WorldOptions& options);

/// Takes away whom the convoy would touch in any frame, then whom those who come towards it would
/// (parked cars and people), then drivers whom the own vehicle would touch, and of drivers who
/// touch each other the later one. All by index: parked cars and people, then the convoy, if any,
/// then from `drivers` on those who drive.
void clearTheWay(Population& population, const Route& route, std::size_t drivers,
                 const std::vector<std::size_t>& convoy, const std::vector<std::size_t>& oncoming);

}  // namespace djpete::simulator
