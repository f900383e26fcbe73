/// Visual odometry alone on a drive in KITTI's odometry layout: times per step and error.
/// `djpete_bench_frontend SEQUENCE POSES FIRST:END [options as key=value] [colour=1] [repeat=N]
/// [scans=1] [threads=N]`
/// Images are read before the clock starts; CPU times are those of the whole process.
#include <mrpt/config/CConfigFileMemory.h>

#include <algorithm>
#include <ctime>
#include <iostream>
#include <map>
#include <opencv2/core/utility.hpp>

#include "djpete_test/ate.h"
#include "kitti_folder.h"

namespace {

using namespace djpete;
using djpete_test::SE3;

struct Arguments {
    std::filesystem::path sequence, poses;
    std::size_t first = 0, end = 0;
    bool colour = false, scans = false;
    int repeat = 3, threads = 0;
    frontend::FrontendOptions options;
};

Arguments parse(int argc, char** argv) {
    if (argc < 4)
        throw std::runtime_error(
            "use: djpete_bench_frontend SEQUENCE POSES FIRST:END "
            "[colour=1] [scans=1] [repeat=N] [threads=N] [option=value ...]");
    Arguments a;
    a.sequence = argv[1];
    a.poses = argv[2];
    const std::string range = argv[3];
    a.first = std::stoul(range);
    a.end = std::stoul(range.substr(range.find(':') + 1));
    mrpt::config::CConfigFileMemory config;
    a.options.saveToConfigFile(config, "frontend");
    std::map<std::string, int> own{{"colour", 0}, {"scans", 0}, {"repeat", 3}, {"threads", 0}};
    for (int i = 4; i < argc; ++i) {
        const std::string text = argv[i];
        const auto at = text.find('=');
        const std::string key = text.substr(0, at), value = text.substr(at + 1);
        if (own.count(key) != 0) {
            own[key] = std::stoi(value);
        } else if (at != std::string::npos && config.keyExists("frontend", key)) {
            config.write("frontend", key, value);
        } else {
            throw std::runtime_error(text + ": expected key=value of section [frontend]");
        }
    }
    a.options.loadFromConfigFile(config, "frontend");
    a.colour = own["colour"] != 0;
    a.scans = own["scans"] != 0;
    a.repeat = own["repeat"];
    a.threads = own["threads"];
    return a;
}

double cpu_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// What one pass over the drive took and found.
struct Pass {
    std::map<std::string, std::vector<double>> figures;
    std::vector<SE3> T_odom_cam;
    int lost = 0, keyframes = 0, fullSearches = 0;
    double cpuPerFrame_ms = 0;
};

Pass drive(const std::vector<frontend::OdometryInput>& inputs,
           const frontend::FrontendOptions& options) {
    frontend::VisualOdometry odometry(options);
    Pass p;
    const double start_ms = cpu_ms();
    for (const auto& in : inputs) {
        const auto out = odometry.process(in);
        const auto& s = odometry.last();
        p.T_odom_cam.push_back(out->T_odom_cam);
        p.lost += s.tracked ? 0 : 1;
        p.keyframes += s.keyframe ? 1 : 0;
        p.fullSearches += s.usedFullSearch ? 1 : 0;
        const std::pair<const char*, double> row[] = {{"1 prepare ms", s.times.prepare_ms},
                                                      {"2 track ms", s.times.track_ms},
                                                      {"3 stereo ms", s.times.stereo_ms},
                                                      {"4 lidar ms", s.times.lidar_ms},
                                                      {"5 pose ms", s.times.pose_ms},
                                                      {"6 detect ms", s.times.detect_ms},
                                                      {"7 total ms", s.times.total_ms},
                                                      {"followed", s.followed},
                                                      {"inliers", s.inliers},
                                                      {"stereo", s.stereoMatched},
                                                      {"added", s.added},
                                                      {"features", s.features},
                                                      {"rms px", s.rms_px}};
        for (const auto& [name, value] : row) p.figures[name].push_back(value);
    }
    p.cpuPerFrame_ms = (cpu_ms() - start_ms) / static_cast<double>(inputs.size());
    return p;
}

double percentile(std::vector<double> v, double share) {
    std::sort(v.begin(), v.end());
    return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1))];
}

void printErrors(const std::vector<SE3>& estimate, const std::vector<SE3>& truth) {
    const auto n = static_cast<std::ptrdiff_t>(std::min(estimate.size(), truth.size()));
    for (std::ptrdiff_t from : {std::ptrdiff_t{0}, std::ptrdiff_t{14}}) {
        if (n - from < 5) continue;
        std::printf("ATE from frame %td: %.4f m\n", from,
                    djpete_test::ateSe3_m({estimate.begin() + from, estimate.begin() + n},
                                          {truth.begin() + from, truth.begin() + n}));
    }
    double way = 0, wayTruth = 0, square = 0, squareTurn = 0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(n); ++i) {
        const SE3 a = estimate[i - 1].inverse() * estimate[i];
        const SE3 b = truth[i - 1].inverse() * truth[i];
        way += a.translation().norm();
        wayTruth += b.translation().norm();
        const auto e = (b.inverse() * a).log();
        square += e.head<3>().squaredNorm();
        squareTurn += e.tail<3>().squaredNorm();
    }
    const auto steps = static_cast<double>(n - 1);
    std::printf("way %.3f m (truth %.3f, ratio %.5f), RPE %.2f mm, %.2f mdeg per frame\n", way,
                wayTruth, way / wayTruth, 1e3 * std::sqrt(square / steps),
                1e3 * std::sqrt(squareTurn / steps) * 180 / M_PI);
}

void run(const Arguments& a) {
    if (a.threads > 0) cv::setNumThreads(a.threads);
    const auto folder = djpete_test::KittiFolder::odometry(a.sequence, a.colour);
    const auto poses = djpete_test::readPoses(a.poses);
    std::vector<obs::LidarScan> scans(a.end - a.first);
    std::vector<frontend::OdometryInput> inputs;
    for (std::size_t i = a.first; i < a.end; ++i) {
        inputs.push_back(folder.load(i, scans[i - a.first]));
        if (!a.scans) inputs.back().scan = nullptr;
    }
    std::optional<Pass> best;
    for (int i = 0; i < a.repeat; ++i) {
        Pass p = drive(inputs, a.options);
        if (!best || p.cpuPerFrame_ms < best->cpuPerFrame_ms) best = std::move(p);
    }
    for (const auto& [name, values] : best->figures) {
        double sum = 0;
        for (double v : values) sum += v;
        std::printf("%-14s mean %8.3f  p50 %8.3f  p95 %8.3f  max %8.3f\n", name.c_str(),
                    sum / static_cast<double>(values.size()), percentile(values, 0.5),
                    percentile(values, 0.95), percentile(values, 1.0));
    }
    std::printf("CPU per frame %.2f ms; %d lost, %d keyframes, %d full searches\n",
                best->cpuPerFrame_ms, best->lost, best->keyframes, best->fullSearches);
    std::vector<SE3> estimate, truth;
    for (std::size_t i = 0; i < inputs.size() && a.first + i < poses.size(); ++i) {
        estimate.push_back(folder.camera.T_vehicle_cam.inverse() * best->T_odom_cam[i]);
        truth.push_back(poses[a.first + i]);
    }
    printErrors(estimate, truth);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(parse(argc, argv));
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete_bench_frontend: " << e.what() << "\n";
        return 1;
    }
}
