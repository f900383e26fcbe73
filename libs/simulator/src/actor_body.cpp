#include "actor_body.h"

#include "noise.h"

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

uint32_t phasesOf(ActorType) { return 1; }

CarBody makeBody(const Actor& actor, uint32_t) { return makeCarBody(actor.kind, actor.seed); }

geometry::Vec3 bodySize(const Actor& actor) { return makeCarBody(actor.kind, actor.seed).size_m; }

}  // namespace djpete::simulator
