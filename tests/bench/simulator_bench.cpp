/// Speed of the simulator: start-up, camera images, scans, as milliseconds of CPU over all threads.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "djpete/simulator/renderer.h"

namespace sim = djpete::simulator;

namespace {

double cpu_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

/// Arguments: number of frames (default 4), threads (default 2), seed (default 1).
int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 4;
    const unsigned threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 2;
    sim::WorldOptions options;
    options.seed = argc > 3 ? static_cast<uint32_t>(std::atoi(argv[3])) : 1;
    const double begin = cpu_ms();
    const sim::World world(options);
    const double made = cpu_ms();
    sim::Renderer renderer(world, threads);
    const double ready = cpu_ms();
    const auto camera = sim::rigCamera(1241, 376);
    const djpete::geometry::SE3 T_left_right(djpete::geometry::Mat3::Identity(),
                                             {camera.baseline_m, 0, 0});
    // The first image also makes the textures.
    renderer.renderCamera(0, sim::rigCamera(64, 32), sim::T_vehicle_camera(), 0);
    const double warm = cpu_ms();
    double images = 0, scans = 0;
    for (int f = 0; f < frames; ++f) {
        const auto frame = static_cast<uint64_t>(f) * 25U;
        const double t0 = cpu_ms();
        renderer.renderCamera(frame, camera, sim::T_vehicle_camera(), 0);
        const double t0b = cpu_ms();
        renderer.renderCamera(frame, camera, sim::T_vehicle_camera() * T_left_right, 1);
        const double t1 = cpu_ms();
        renderer.scan(frame, {});
        const double t2 = cpu_ms();
        std::printf("frame %3d: left %6.0f ms, right %6.0f ms, scan %6.0f ms\n",
                    static_cast<int>(frame), t0b - t0, t1 - t0b, t2 - t1);
        images += t1 - t0;
        scans += t2 - t1;
    }
    std::printf(
        "CPU: world %.0f ms, scene %.0f ms, textures %.0f ms; per image %.0f ms, per scan "
        "%.0f ms\n",
        made - begin, ready - made, warm - ready, 0.5 * images / frames, scans / frames);
    return 0;
}
