#include "places_drive.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include "djpete/frontend/visual_odometry.h"
#include "djpete/obs/rawlog_source.h"
#include "kitti_folder.h"

namespace djpete_bench {

namespace fs = std::filesystem;
using djpete::obs::CObservationVisualKeyframe;
using Keyframes = std::vector<CObservationVisualKeyframe::Ptr>;

namespace {

/// Feeds frames to the front end and keeps the keyframes.
class Runner {
  public:
    void process(const djpete::frontend::OdometryInput& input) {
        auto out = odometry_.process(input);
        sum_ms_ += odometry_.last().times.total_ms;
        ++frames_;
        if (out->isKeyframe) keyframes.push_back(std::move(out));
    }
    double mean_ms() const { return frames_ > 0 ? sum_ms_ / frames_ : 0; }
    Keyframes keyframes;

  private:
    djpete::frontend::VisualOdometry odometry_;
    double sum_ms_ = 0;
    int frames_ = 0;
};

void runRawlog(Runner& runner, const fs::path& file) {
    djpete::obs::RawlogSource source(file);
    while (const auto frame = source.next()) {
        const auto images = frame->loadMainImages();
        if (!images) continue;
        runner.process({frame->id, frame->stamp, *images, nullptr, std::nullopt});
        frame->unload();
    }
}

void runFolder(Runner& runner, const fs::path& dir) {
    auto folder = djpete_test::KittiFolder::odometry(dir, false);
    folder.scans = fs::path();
    const auto fileOf = [&](std::size_t i) {
        return folder.left / djpete_test::KittiFolder::numbered(i, folder.digits, ".png");
    };
    std::size_t first = 0;
    while (first < 100000 && !fs::exists(fileOf(first))) ++first;
    djpete::obs::LidarScan unused;
    for (std::size_t i = first; fs::exists(fileOf(i)); ++i) runner.process(folder.load(i, unused));
}

Keyframes readCache(const fs::path& file) {
    mrpt::rtti::registerClass(CLASS_ID(CObservationVisualKeyframe));
    mrpt::io::CFileGZInputStream in(file.string());
    auto archive = mrpt::serialization::archiveFrom(in);
    const auto count = archive.ReadAs<uint64_t>();
    Keyframes out;
    for (uint64_t i = 0; i < count; ++i) {
        out.push_back(archive.ReadObject<CObservationVisualKeyframe>());
    }
    return out;
}

void writeCache(const Keyframes& keyframes, const fs::path& file) {
    mrpt::io::CFileGZOutputStream out(file.string());
    auto archive = mrpt::serialization::archiveFrom(out);
    archive << static_cast<uint64_t>(keyframes.size());
    for (const auto& k : keyframes) archive << *k;
}

}  // namespace

PlacesDrive openPlacesDrive(const fs::path& drive, const fs::path& truth, const fs::path& cache) {
    PlacesDrive out;
    Keyframes found;
    if (!cache.empty() && fs::exists(cache)) {
        found = readCache(cache);
    } else {
        Runner runner;
        if (fs::is_directory(drive)) {
            runFolder(runner, drive);
        } else {
            runRawlog(runner, drive);
        }
        found = std::move(runner.keyframes);
        out.frontend_ms = runner.mean_ms();
        if (!cache.empty()) writeCache(found, cache);
    }
    if (found.empty()) throw std::runtime_error(drive.string() + ": no keyframe; expected images");
    const auto poses = djpete_test::readPoses(truth);
    for (const auto& k : found) {
        if (k->frame.value >= poses.size()) {
            throw std::runtime_error(truth.string() + ": " + std::to_string(poses.size()) +
                                     " poses, but the drive has frame " +
                                     std::to_string(k->frame.value));
        }
        djpete::map::Keyframe keyframe;
        keyframe.id.value = out.keyframes.size();
        keyframe.frame = k->frame;
        keyframe.stamp = k->timestamp;
        keyframe.camera = k->camera;
        keyframe.features = k->features;
        keyframe.landmarks.resize(k->features.size());
        out.keyframes.push_back(std::move(keyframe));
        out.T_true_cam.push_back(poses[k->frame.value]);
    }
    return out;
}

}  // namespace djpete_bench
