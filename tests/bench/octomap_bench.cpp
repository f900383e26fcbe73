/// The octree of the background over real scans: `djpete_bench_octomap [SCANS]` (default 100).
/// The shared data holds scans 0 to 15 of KITTI odometry 00, with official poses: they are driven
/// again and again, each time from where the last time ended, so that every scan meets new ground.
/// Objects are left in. Scans and images are in memory beforehand.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

#include "djpete/background/octo_worker.h"
#include "djpete_test/shared_data.h"

namespace {

using namespace djpete;
using geometry::SE3;
namespace fs = std::filesystem;

constexpr int kScans = 16;

double peak_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// A 3x4 matrix after an optional word.
SE3 poseOf(std::istream& in) {
    geometry::Mat3 R;
    geometry::Vec3 t;
    for (int r = 0; r < 3; ++r) in >> R(r, 0) >> R(r, 1) >> R(r, 2) >> t[r];
    if (!in) throw std::runtime_error("expected twelve numbers");
    return SE3(R, t).normalised();
}

struct Rig {
    geometry::StereoCamera camera;
    SE3 T_cam_velo;
};

Rig readRig(const fs::path& file) {
    Rig rig;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream row(line);
        std::string word;
        row >> word;
        if (word == "Tr:") rig.T_cam_velo = poseOf(row);
        if (word != "P0:") continue;
        double skew = 0, zero = 0;
        row >> rig.camera.fx >> skew >> rig.camera.cx >> zero >> zero >> rig.camera.fy >>
            rig.camera.cy;
    }
    return rig;
}

obs::LidarScan readScan(const fs::path& file) {
    obs::LidarScan out;
    std::ifstream in(file, std::ios::binary);
    std::array<float, 4> p{};
    while (in.read(reinterpret_cast<char*>(p.data()), sizeof(p))) {
        out.points.push_back({p[0], p[1], p[2], p[3]});
    }
    if (out.points.empty()) throw std::runtime_error(file.string() + ": no points");
    return out;
}

struct Drive {
    std::vector<texture::TextureView> views;
    std::vector<SE3> T_start_cam;  ///< one more than views
};

/// Vehicle = velo.
Drive readDrive(const fs::path& odometry) {
    const auto sequence = odometry / "sequences" / "00";
    Rig rig = readRig(sequence / "calib.txt");
    Drive out;
    std::ifstream poses(odometry / "poses" / "00.txt");
    for (int i = 0; i <= kScans; ++i) {
        out.T_start_cam.push_back(poseOf(poses));
        if (i == kScans) break;
        char name[16];
        std::snprintf(name, sizeof(name), "%06d", i);
        texture::TextureView view;
        const auto image = (sequence / "image_0" / (std::string(name) + ".png")).string();
        if (!view.images.left.loadFromFile(image)) throw std::runtime_error(image + ": no image");
        rig.camera.width_px = static_cast<int>(view.images.left.getWidth());
        rig.camera.height_px = static_cast<int>(view.images.left.getHeight());
        view.images.camera = {rig.camera, rig.T_cam_velo.inverse()};
        view.scan = readScan(sequence / "velodyne" / (std::string(name) + ".bin"));
        out.views.push_back(std::move(view));
    }
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int count = argc > 1 ? std::atoi(argv[1]) : 100;
        const auto folder = djpete_test::shared("data/kitti/odometry");
        if (!folder) throw std::runtime_error("needs shared data (data/kitti/odometry)");
        const Drive drive = readDrive(*folder);
        const double before_mb = peak_mb();
        background::OctoWorker worker(background::OctoOptions(), true);
        const SE3 T_velo_cam = drive.views[0].images.camera.T_vehicle_cam;
        const SE3 T_lap = drive.T_start_cam.back();
        SE3 T_world_start;  // frame: first camera with the vehicle's axes
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < count; ++i) {
            const auto k = static_cast<std::size_t>(i % kScans);
            if (i > 0 && k == 0) T_world_start = (T_world_start * T_lap).normalised();
            auto view = drive.views[k];
            view.frame = obs::FrameId{static_cast<uint64_t>(i)};
            view.T_world_cam = T_velo_cam * T_world_start * drive.T_start_cam[k];
            view.T_world_vehicle = view.T_world_cam * T_velo_cam.inverse();
            worker.push(std::move(view));
        }
        const auto pushed = std::chrono::steady_clock::now();
        worker.finish(map::SlamMap());
        const auto end = std::chrono::steady_clock::now();
        const auto times = worker.times();
        const auto ms = [](auto from, auto to) {
            return std::chrono::duration<double, std::milli>(to - from).count();
        };
        std::printf("scans %d (%d different), %.0f m, points per scan %zu\n", count,
                    std::min(count, kScans), T_lap.translation().norm() * count / kScans,
                    drive.views[0].scan->points.size());
        std::printf("worker, ms per scan: p50 %.1f  p95 %.1f  max %.1f  = %.1f scans/s\n",
                    times.p50_ms(), times.p95_ms(), times.max_ms(),
                    1000 * double(times.count()) / times.total_ms());
        std::printf("pushing all %.0f ms, rest and finish %.0f ms\n", ms(start, pushed),
                    ms(pushed, end));
        std::printf("occupied voxels %zu, with colour %zu\n", worker.tree().points(true).size(),
                    worker.tree().points().size());
        for (const auto& [name, value] : worker.counters()) {
            std::printf("%-50s %llu\n", name.c_str(), static_cast<unsigned long long>(value));
        }
        std::printf("memory: peak %.0f MB, before the worker %.0f MB\n", peak_mb(), before_mb);
        if (argc > 2) worker.tree().writeOt(argv[2]);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete_bench_octomap: " << e.what() << "\n";
        return 1;
    }
}
