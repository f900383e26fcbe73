/// Speed of association and object worker on recorded drives without images: djpete_bench_tracking
/// DRIVE.rawlog ..., as kitti2rawlog makes them from a folder of KITTI tracking with --detections
/// and --poses. Reading is not counted; nothing else is on the clock.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "djpete/backend/map_keeper.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete/observers/recorded_observer.h"
#include "djpete/pipeline/pose_odometry.h"

namespace {

using namespace djpete;
using Clock = std::chrono::steady_clock;

constexpr int kRuns = 5;

/// What the back end is given of a drive.
struct Drive {
    struct Frame {
        obs::CObservationVisualKeyframe::Ptr odometry;
        obs::CObservationDetectedObjects::Ptr detections;
    };
    std::vector<Frame> frames;
    std::size_t detections = 0;
};

/// Throws obs::InputError naming the file if it is no drive with a calibration and poses.
Drive readDrive(const std::filesystem::path& rawlog) {
    obs::RawlogSource source(rawlog);
    const auto companion = rawlog.parent_path() / (rawlog.stem().string() + "_objects.rawlog");
    observers::RecordedObserver recorded = std::filesystem::exists(companion)
                                               ? observers::RecordedObserver(companion)
                                               : observers::RecordedObserver();
    pipeline::PoseOdometry odometry(source.info().mainCamera(source.path()));
    Drive drive;
    while (const auto frame = source.next()) {
        Drive::Frame f{odometry.process(*frame), recorded.observe(*frame, nullptr, nullptr)};
        if (f.detections) drive.detections += f.detections->detections.size();
        drive.frames.push_back(std::move(f));
    }
    return drive;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void bench(const std::filesystem::path& rawlog) {
    const Drive drive = readDrive(rawlog);
    std::vector<double> time_ms;
    std::map<std::string, std::vector<double>> stage_ms;
    std::size_t objects = 0;
    for (int run = 0; run < kRuns; ++run) {
        const auto begin = Clock::now();
        backend::MapKeeper keeper({}, backend::Mode::Lockstep);
        for (const auto& f : drive.frames) keeper.addFrame(f.odometry, f.detections);
        keeper.finish();
        time_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
        objects = keeper.map().objects().size();
        for (const auto& [stage, times] : keeper.statistics().stages) {
            stage_ms[stage].push_back(times.total_ms());
        }
    }
    const auto n = static_cast<double>(drive.frames.size());
    std::printf("%s: %zu frames, %zu detections, %zu objects: %.0f frames/s (median of %d)\n",
                rawlog.stem().c_str(), drive.frames.size(), drive.detections, objects,
                1000 * n / median(time_ms), kRuns);
    for (const auto& [stage, values] : stage_ms) {
        std::printf("  %-28s %8.3f ms per frame\n", stage.c_str(), median(values) / n);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::printf("djpete_bench_tracking: expected one or more rawlogs of drives with poses\n");
        return 1;
    }
    try {
        for (int i = 1; i < argc; ++i) bench(argv[i]);
    } catch (const std::exception& e) {
        std::printf("djpete_bench_tracking: %s\n", e.what());
        return 1;
    }
    return 0;
}
