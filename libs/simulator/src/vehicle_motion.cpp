#include "vehicle_motion.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec6;

namespace {

/// log of the motion that leads from a frame to the next.
Vec6 stepFrom(const World& world, uint64_t frame) {
    return (world.T_world_vehicle(frame).inverse() * world.T_world_vehicle(frame + 1)).log();
}

}  // namespace

SE3 vehicleBetween(const World& world, uint64_t frame, double share) {
    const SE3 T_world_vehicle = world.T_world_vehicle(frame);
    if (share == 0) return T_world_vehicle;
    const bool before = share < 0 && frame > 0;
    // T(f) exp(-step) = T(f - 1): the step before can be gone from its end too.
    const Vec6 step = stepFrom(world, before ? frame - 1 : frame);
    return T_world_vehicle * SE3::exp(share * step);
}

Vec6 vehicleTwist(const World& world, uint64_t frame) {
    const Vec6 after = stepFrom(world, frame);
    const Vec6 before = frame > 0 ? stepFrom(world, frame - 1) : after;
    return 0.5 / world.options().period_s * (before + after);
}

}  // namespace djpete::simulator
