/// Bodies of all actors.
#pragma once

#include <array>
#include <vector>

#include "car_body.h"
#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// Shapes of a walking person, evenly over one double step.
constexpr uint32_t kGaitPhases = 8;
constexpr float kDoubleStep_m = 1.45F;  ///< way of a pedestrian in one round of its shapes
constexpr float kPedalTurn_m = 5.2F;    ///< of a cyclist

/// Every vehicle body there is, as (type, kind of that type).
struct BodyKind {
    ActorType type;
    uint32_t kind;
};
constexpr std::array<BodyKind, 7> kVehicleBodies{{{ActorType::Car, 0},
                                                  {ActorType::Car, 1},
                                                  {ActorType::Car, 2},
                                                  {ActorType::Car, 3},
                                                  {ActorType::Van, kVan},
                                                  {ActorType::Car, 5},
                                                  {ActorType::Car, 6}}};

/// How many shapes an actor of a type goes through.
uint32_t phasesOf(ActorType type);
/// One shape of an actor in frame obj. Its box is the actor's box, which holds all its shapes.
CarBody makeBody(const Actor& actor, uint32_t phase);
/// Size (length, width, height) of the box around all shapes of an actor.
geometry::Vec3 bodySize(const Actor& actor);

}  // namespace djpete::simulator
