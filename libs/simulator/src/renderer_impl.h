/// State of a Renderer; its cameras, LiDAR and views of cars are in files of their own.
#pragma once

#include <algorithm>
#include <optional>

#include "djpete/simulator/renderer.h"
#include "ray_scene.h"

namespace djpete::simulator {

struct Renderer::Impl {
    Impl(const World& world, unsigned n) : scene(world), threads(std::max(1U, n)) {}

    void setFrame(uint64_t frame) {
        if (current && *current == frame) return;
        scene.setFrame(frame);
        current = frame;
    }

    RayScene scene;
    unsigned threads;
    std::optional<uint64_t> current;
};

}  // namespace djpete::simulator
