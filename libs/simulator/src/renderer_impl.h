/// State of a Renderer; its cameras, LiDAR and views of cars are in files of their own.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "development.h"
#include "djpete/simulator/renderer.h"

namespace djpete::simulator {

struct Renderer::Impl {
    Impl(const World& world, unsigned n, const CameraModel& model)
        : scene(world), threads(std::max(1U, n)), cameraModel(model) {}

    void setFrame(uint64_t frame) {
        if (current && *current == frame) return;
        scene.setFrame(frame);
        current = frame;
    }

    /// Mean brightness of what the left camera sees, from a few rays.
    double brightness(uint64_t frame);
    /// Of both cameras at a frame: an answer to the frames before it, whichever were rendered.
    Exposure exposure(uint64_t frame);
    /// The same without CameraModel::exposureSwing: shutter times gain.
    double automaticExposure(uint64_t frame);

    RayScene scene;
    unsigned threads;
    CameraModel cameraModel;
    std::optional<uint64_t> current;
    std::map<uint64_t, double> brightnessAt;  // of the last frames
    std::vector<Look> looks;                  // of the last picture; kept for their memory
    std::vector<Vec3f> colours;               // likewise
};

}  // namespace djpete::simulator
