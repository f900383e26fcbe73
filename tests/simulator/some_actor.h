/// An actor without a world.
#pragma once

#include "actor_body.h"

namespace djpete::simulator {

inline Actor actorOf(ActorType type, uint32_t kind, uint32_t seed) {
    Actor actor;
    actor.id = 1;
    actor.type = type;
    actor.kind = kind;
    actor.seed = seed;
    actor.size_m = bodySize(actor);
    return actor;
}

}  // namespace djpete::simulator
