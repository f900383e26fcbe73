/// Worlds, and what must be true of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "boxes.h"
#include "small_drive.h"
#include "street_builder.h"

namespace some_world {

namespace sim = djpete::simulator;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;

inline sim::WorldOptions drive(sim::RouteKind kind, uint64_t frames) {
    sim::WorldOptions o;
    o.route = kind;
    o.frames = frames;
    return o;
}

/// Of the boxes of all actors and the own vehicle, in every `every`-th frame.
inline void expectNobodyTouches(const sim::World& world, uint64_t every) {
    const Vec3 own(4.4, 1.8, 1.5);
    for (uint64_t f = 0; f < world.frames(); f += every) {
        std::vector<std::pair<SE3, const sim::Actor*>> here;
        for (const auto& a : world.actors())
            if (world.present(a, f)) here.emplace_back(world.T_world_obj(a, f), &a);
        const SE3 T_world_own = world.T_world_vehicle(f);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const auto& [T_a, a] = here[i];
            EXPECT_GT(sim::gapBetween(T_a, a->size_m, T_world_own, own), 0.0)
                << "actor " << a->id << " and the own vehicle in frame " << f;
            for (std::size_t k = 0; k < i; ++k) {
                const auto& [T_b, b] = here[k];
                if ((T_a.translation() - T_b.translation()).norm() > 12) continue;
                EXPECT_GT(sim::gapBetween(T_a, a->size_m, T_b, b->size_m), 0.0)
                    << nameOf(a->type) << " " << a->id << " and " << nameOf(b->type) << " " << b->id
                    << " in frame " << f;
            }
        }
    }
}

/// Ground, houses, signs and plants of both.
inline void expectSameStreets(const sim::World& a, const sim::World& b) {
    const auto x = sim::buildStreet(a.network(), a.options().seed),
               y = sim::buildStreet(b.network(), b.options().seed);
    EXPECT_TRUE(x.mesh.vertices == y.mesh.vertices);
    EXPECT_TRUE(x.mesh.uv == y.mesh.uv);
    ASSERT_EQ(x.mesh.finishes.size(), y.mesh.finishes.size());
    for (std::size_t i = 0; i < x.mesh.finishes.size(); ++i)
        ASSERT_EQ(x.mesh.finishes[i].seed, y.mesh.finishes[i].seed);
    ASSERT_EQ(x.plants.size(), y.plants.size());
    for (std::size_t i = 0; i < x.plants.size(); ++i)
        ASSERT_TRUE(x.plants[i].foot == y.plants[i].foot &&
                    x.plants[i].yaw_rad == y.plants[i].yaw_rad);
}

}  // namespace some_world
