/// Small simulated drives, in memory or written by the program in-process.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "djpete/simulator/labels.h"
#include "djpete/simulator/renderer.h"
#include "djpete_test/shared_data.h"
#include "simulate_drive_app.h"

namespace small_drive {

namespace fs = std::filesystem;
namespace sim = djpete::simulator;
using djpete::geometry::SE3;
using djpete::geometry::StereoCamera;
using djpete::geometry::Vec3;

/// Runs simulate-drive; its words follow the program's name.
inline void simulate(const std::vector<std::string>& words) {
    std::vector<const char*> argv{"simulate-drive"};
    for (const auto& w : words) argv.push_back(w.c_str());
    djpete::apps::SimulateDriveApp app;
    ASSERT_TRUE(app.initialize(static_cast<int>(argv.size()), argv.data()));
    std::ostringstream out;
    app.run(out);
}

inline std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The rows of a file of numbers.
inline std::vector<std::vector<double>> numbersOf(const fs::path& file) {
    std::vector<std::vector<double>> rows;
    std::istringstream in(textOf(file));
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        rows.emplace_back(std::istream_iterator<double>(words), std::istream_iterator<double>());
        EXPECT_TRUE(words.eof()) << file << ": " << line;
    }
    return rows;
}

/// Every file below a folder with its bytes.
inline std::map<std::string, std::string> filesOf(const fs::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& e : fs::recursive_directory_iterator(folder)) {
        if (e.is_regular_file()) out[fs::relative(e.path(), folder).string()] = textOf(e.path());
    }
    return out;
}

/// One world with its rig and the left picture and labels of frames, all in memory.
struct Scene {
    explicit Scene(uint32_t seed, int width = 620, int height = 188)
        : world(options(seed)), renderer(world, 2), camera(sim::rigCamera(width, height)) {}

    static sim::WorldOptions options(uint32_t seed) {
        sim::WorldOptions o;
        o.seed = seed;
        o.frames = 40;
        return o;
    }
    sim::RenderedImage left(uint64_t frame) {
        return renderer.renderCamera(frame, camera, sim::T_vehicle_camera(), 0);
    }
    std::vector<sim::Label> labels(uint64_t frame, const sim::RenderedImage& image) {
        return sim::makeLabels(renderer, world, frame, camera, sim::T_vehicle_camera(), image, {});
    }

    sim::World world;
    sim::Renderer renderer;
    StereoCamera camera;
};

/// The pose a label states: T_cam_obj.
inline SE3 poseOf(const sim::Label& l) {
    djpete::geometry::Mat3 axes;  // obj axes in cam at rotation 0: front along x, up along -y
    axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    const Vec3 bottom(l.x_m, l.y_m, l.z_m);
    const SE3 turned(axes, bottom);
    // KITTI's rotation is right-handed about the camera's y, which is obj's -z.
    return turned * SE3::fromYaw(-l.rotationY_rad, Vec3(0, 0, 0.5 * l.height_m));
}

}  // namespace small_drive
