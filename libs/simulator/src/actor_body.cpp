#include "actor_body.h"

namespace djpete::simulator {

uint32_t phasesOf(ActorType) { return 1; }

CarBody makeBody(const Actor& actor, uint32_t) { return makeCarBody(actor.kind, actor.seed); }

geometry::Vec3 bodySize(const Actor& actor) { return makeCarBody(actor.kind, actor.seed).size_m; }

}  // namespace djpete::simulator
