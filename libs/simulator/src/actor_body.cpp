#include "actor_body.h"

#include "noise.h"
#include "person_body.h"
#include "truck_body.h"

namespace djpete::simulator {

BodyKind drawVehicle(uint32_t seed) {
    uint32_t all = 0;
    for (const auto& body : kVehicleBodies) all += body.weight;
    uint32_t draw = hash(seed, 1U) % all;
    for (const auto& body : kVehicleBodies) {
        if (draw < body.weight) return body;
        draw -= body.weight;
    }
    return kVehicleBodies.front();
}

uint32_t phasesOf(ActorType type) {
    return type == ActorType::Pedestrian || type == ActorType::Cyclist ? kGaitPhases : 1;
}

std::vector<CarBody> makeShapes(const Actor& actor) {
    std::vector<CarBody> shapes;
    switch (actor.type) {
        case ActorType::Pedestrian:
            return makePersonShapes(actor.seed, kGaitPhases);
        case ActorType::Cyclist:
            return makeCyclistShapes(actor.seed, kGaitPhases);
        case ActorType::Truck:
            shapes.push_back(makeTruckBody(actor.seed));
            return shapes;
        default:
            shapes.push_back(makeCarBody(actor.kind, actor.seed));
            return shapes;
    }
}

CarBody makeBody(const Actor& actor, uint32_t phase) {
    return std::move(makeShapes(actor).at(phase));
}

geometry::Vec3 bodySize(const Actor& actor) { return makeShapes(actor).front().size_m; }

}  // namespace djpete::simulator
