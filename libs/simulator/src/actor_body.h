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

/// A vehicle body, as (type, kind of that type), and how often it is drawn.
struct BodyKind {
    ActorType type;
    uint32_t kind;
    uint32_t weight;
};
/// Every vehicle body there is. One in 10 is a van, one in 33 a truck.
constexpr std::array<BodyKind, 11> kVehicleBodies{{{ActorType::Car, 0, 26},
                                                   {ActorType::Car, 1, 15},
                                                   {ActorType::Car, 2, 14},
                                                   {ActorType::Car, 3, 14},
                                                   {ActorType::Van, kVan, 4},
                                                   {ActorType::Car, 5, 13},
                                                   {ActorType::Car, kPickUp, 2},
                                                   {ActorType::Van, kMinibus, 3},
                                                   {ActorType::Car, 8, 6},
                                                   {ActorType::Van, kTallVan, 3},
                                                   {ActorType::Truck, 0, 3}}};
/// One of kVehicleBodies, by weight.
BodyKind drawVehicle(uint32_t seed);

/// How many shapes an actor of a type goes through.
uint32_t phasesOf(ActorType type);
/// All shapes of an actor in frame obj, at about the cost of one of them with its box: their common
/// box is the actor's.
std::vector<CarBody> makeShapes(const Actor& actor);
/// One of them; `phase` < phasesOf the type.
CarBody makeBody(const Actor& actor, uint32_t phase);
/// Size (length, width, height) of the box around all shapes of an actor.
geometry::Vec3 bodySize(const Actor& actor);

}  // namespace djpete::simulator
