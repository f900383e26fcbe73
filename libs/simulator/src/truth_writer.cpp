#include "truth_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "number_rows.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec3;

namespace {

struct Motion {
    Vec3 velocity_mps = Vec3::Zero();  ///< in world
    double turnRate_radps = 0;         ///< about world's z
};

Motion motionOf(const World& world, const Actor& actor, uint64_t frame) {
    const uint64_t before = frame > 0 && world.present(actor, frame - 1) ? frame - 1 : frame;
    const uint64_t after = world.present(actor, frame + 1) ? frame + 1 : frame;
    Motion m;
    if (before == after || !actor.moving) return m;
    const double seconds = static_cast<double>(after - before) * world.options().period_s;
    const SE3 T_world_before = world.T_world_obj(actor, before);
    const SE3 T_world_after = world.T_world_obj(actor, after);
    m.velocity_mps = (T_world_after.translation() - T_world_before.translation()) / seconds;
    m.turnRate_radps =
        geometry::wrapAngle(T_world_after.yaw_rad() - T_world_before.yaw_rad()) / seconds;
    return m;
}

/// The simulator's own world has its origin on the ground; files have it in the first vehicle.
SE3 T_first_world(const World& world) { return world.T_world_start().inverse(); }

}  // namespace

std::map<uint32_t, uint16_t> maskCodes(const std::vector<Label>& labels) {
    std::map<uint32_t, uint16_t> codes;
    for (const auto& l : labels) {
        if (l.type == "Cyclist") continue;
        const uint32_t kind = l.type == "Pedestrian" ? 2 : 1;
        codes[l.trackId] = static_cast<uint16_t>(1000 * kind + l.trackId);
    }
    return codes;
}

std::string objectRows(const World& world, uint64_t frame, const RenderedImage& image,
                       double range_m) {
    std::set<uint32_t> seen;
    uint32_t last = 0;
    for (uint32_t id : image.actorId) {
        if (id != last && id != 0) seen.insert(id);
        last = id;
    }
    const Vec3 own = world.T_world_vehicle(frame).translation();
    const SE3 T_first = T_first_world(world);
    std::string rows;
    for (const auto& actor : world.actors()) {
        if (!world.present(actor, frame)) continue;
        const SE3 T_world_obj = world.T_world_obj(actor, frame);
        if (seen.count(actor.id) == 0 && (T_world_obj.translation() - own).norm() > range_m)
            continue;
        const Motion motion = motionOf(world, actor, frame);
        const Vec3 v = T_first.rotation() * motion.velocity_mps;
        rows += std::to_string(frame) + " " + std::to_string(actor.id) + " " + nameOf(actor.type) +
                (actor.moving ? " 1 " : " 0 ") + poseRow(T_first * T_world_obj) +
                numberRow({v.x(), v.y(), v.z()}, " %.6f") +
                numberRow({motion.turnRate_radps}, " %.6f") + "\n";
    }
    return rows;
}

std::string movingRow(const World& world, uint64_t frame, const RenderedImage& image) {
    std::vector<bool> counts(world.actors().size() + 1, false);
    for (const auto& actor : world.actors())
        counts[actor.id] =
            actor.moving && actor.type != ActorType::Pedestrian && actor.type != ActorType::Cyclist;
    const auto pixels = std::count_if(image.actorId.begin(), image.actorId.end(),
                                      [&](uint32_t id) { return counts[id]; });
    return std::to_string(frame) +
           numberRow({static_cast<double>(pixels) / static_cast<double>(image.actorId.size())},
                     " %.6f") +
           "\n";
}

std::string exposureRow(uint64_t frame, const RenderedImage& left, const RenderedImage& right) {
    return std::to_string(frame) + numberRow({left.exposure, right.exposure}, " %.6f") + "\n";
}

}  // namespace djpete::simulator
