/// State of a Renderer; its cameras, LiDAR and views of cars are in files of their own.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "djpete/simulator/renderer.h"
#include "ray_scene.h"

namespace djpete::simulator {

/// What a ray saw.
struct Look {
    Vec3f colour = Vec3f::Zero();
    uint32_t surface = 0;  ///< differs between neighbours where there is an edge
    float inverseDepth = 0;
};

struct Renderer::Impl {
    Impl(const World& world, unsigned n, const CameraModel& model)
        : scene(world), threads(std::max(1U, n)), cameraModel(model) {}

    void setFrame(uint64_t frame) {
        if (current && *current == frame) return;
        scene.setFrame(frame);
        current = frame;
    }

    RayScene scene;
    unsigned threads;
    CameraModel cameraModel;
    std::optional<uint64_t> current;
    std::vector<Look> looks;     // of the last picture; kept for their memory
    std::vector<Vec3f> colours;  // likewise
};

}  // namespace djpete::simulator
