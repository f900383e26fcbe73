#include "djpete/pipeline/result_folder.h"

#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "djpete/io/graph_writer.h"
#include "djpete/io/loops_csv.h"
#include "djpete/io/objects_csv.h"
#include "djpete/io/ply_writer.h"
#include "djpete/io/scene_writer.h"
#include "djpete/io/tracking_writer.h"
#include "djpete/io/trajectory_writer.h"
#include "djpete/obs/errors.h"
#include "djpete/texture/object_file.h"

namespace djpete::pipeline {

namespace {

/// Of the frames from `first` on.
double pathLength(const map::SlamMap& map, obs::FrameId first) {
    double length = 0;
    std::optional<geometry::SE3> previous;
    for (auto it = map.frames().lower_bound(first); it != map.frames().end(); ++it) {
        const auto T_world_cam = map.cameraAt(it->first);
        if (previous) length += (T_world_cam->translation() - previous->translation()).norm();
        previous = T_world_cam;
    }
    return length;
}

void fillFigures(const ObjectSlam& slam, RunSummary& s) {
    const auto& map = slam.map();
    const obs::FrameId first = slam.frameInMap({0});
    s.frames = s.tracked = 0;
    for (auto it = map.frames().lower_bound(first); it != map.frames().end(); ++it) {
        ++s.frames;
        s.tracked += it->second.tracked ? 1U : 0U;
    }
    s.keyframes = map.keyframes().size();
    s.landmarks = map.landmarks().size();
    s.objects = map.objects().size();
    s.movingObjects = 0;
    for (const auto& [id, object] : map.objects()) s.movingObjects += object.moving ? 1U : 0U;
    s.texturedObjects = 0;
    s.objectPoints = 0;
    for (const auto& [id, model] : slam.models()) {
        s.texturedObjects += model.coverage() > 0 ? 1U : 0U;
        s.objectPoints += model.size();
    }
    s.pathLength_m = pathLength(map, first);
    s.timings = slam.timings();
    s.counters = slam.counters();
}

nlohmann::json toJson(const RunSummary& s) {
    nlohmann::json timings;
    for (const auto& [stage, t] : s.timings) {
        timings[stage] = {{"calls", t.count()},
                          {"p50", t.p50_ms()},
                          {"p95", t.p95_ms()},
                          {"max", t.max_ms()},
                          {"total", t.total_ms()}};
    }
    nlohmann::json out{{"drive", s.drive},
                       {"frames", s.frames},
                       {"frames_tracked", s.tracked},
                       {"keyframes", s.keyframes},
                       {"landmarks", s.landmarks},
                       {"objects", s.objects},
                       {"objects_moving", s.movingObjects},
                       {"objects_textured", s.texturedObjects},
                       {"object_points", s.objectPoints},
                       {"path_length_m", s.pathLength_m},
                       {"localised_after_frames", nullptr},
                       {"map_load_s", nullptr},
                       {"ate_se3_m", nullptr},
                       {"counters", s.counters},
                       {"wall_s", s.wall_s},
                       {"start_up_s", s.startUp_s},
                       {"peak_memory_mb", s.peakMemory_mb},
                       {"timings_ms", timings},
                       {"error", nullptr}};
    if (s.mapLoad_s) out["map_load_s"] = *s.mapLoad_s;
    if (s.localisedAfter) out["localised_after_frames"] = *s.localisedAfter;
    if (s.ateSe3_m) out["ate_se3_m"] = *s.ateSe3_m;
    if (!s.error.empty()) out["error"] = s.error;
    return out;
}

/// frame,gain,offset: an image shows a colour c (0..255) of the textures as gain * c + offset.
void writeExposures(const ObjectSlam& slam, const std::filesystem::path& file) {
    std::ofstream out(file);
    out << "frame,gain,offset\n" << std::setprecision(9);
    const uint64_t first = slam.frameInMap({0}).value;
    for (const auto& [frame, exposure] : slam.exposures()) {
        out << frame.value - first << "," << exposure.gain << "," << exposure.offset << "\n";
    }
    if (!out) throw obs::InputError(file.string() + ": cannot be written");
}

void writeSummary(const RunSummary& summary, const std::filesystem::path& file) {
    std::ofstream out(file);
    out << toJson(summary).dump(2) << '\n';
    if (!out) throw obs::InputError(file.string() + ": cannot be written");
}

void writeScenes(const ObjectSlam& slam, const ObjectSlamOptions& options,
                 const std::filesystem::path& folder, RunSummary& summary) {
    io::SceneContent content{slam.snapshot(), slam.models(), slam.background()};
    if (const auto* tree = slam.octomap()) {
        content.backgroundVoxel_m = tree->resolution_m();
        tree->writeOt((folder / "background.ot").string());
        tree->writeBt((folder / "background.bt").string());
    }
    const auto scene = io::makeScene(content, options.scene);
    io::writeScene(*scene, (folder / "scene.3Dscene").string());
    const auto report = io::renderScene(*scene, (folder / "scene.png").string(), options.scene);
    summary.picture = report.written ? "" : report.whyNot;
}

uint64_t counter(const RunSummary& s, const std::string& name) {
    const auto it = s.counters.find(name);
    return it == s.counters.end() ? 0 : it->second;
}

}  // namespace

void writeResults(const ObjectSlam& slam, const ObjectSlamOptions& options,
                  const std::filesystem::path& folder, RunSummary& summary) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (!std::filesystem::is_directory(folder)) {
        throw obs::InputError(folder.string() + ": the result folder cannot be made");
    }
    fillFigures(slam, summary);
    if (!slam.map().frames().empty()) {
        const obs::FrameId first = slam.frameInMap({0});
        io::writeTrajectoryTum(slam.map(), (folder / "trajectory.tum").string(), first);
        io::writeTrajectoryKitti(slam.map(), (folder / "trajectory.kitti.txt").string(), first);
        io::writeObjectsCsv(slam.map(), (folder / "objects.csv").string(), first);
        io::writeTracking(slam.map(), (folder / "tracking.txt").string(), first);
        io::writeLoopsCsv(slam.loops(), (folder / "loops.csv").string());
        io::writePoseGraph(slam.map(), (folder / "map.graph").string());
        io::writeObjectPlys(slam.models(), (folder / "objects").string());
        for (const auto& [id, model] : slam.models()) {
            texture::saveObject({model, {}}, folder / "objects" / texture::objectFileName(id));
        }
        writeExposures(slam, folder / "exposures.csv");
        writeScenes(slam, options, folder, summary);
    }
    writeSummary(summary, folder / "summary.json");
}

std::string toText(const RunSummary& s) {
    std::ostringstream o;
    o << std::fixed << std::setprecision(2);
    o << "drive           " << (s.drive.empty() ? "(no name)" : s.drive) << "\n"
      << "frames          " << s.frames << ", tracked " << s.tracked << ", keyframes "
      << s.keyframes << "\n"
      << "path            " << s.pathLength_m << " m\n"
      << "landmarks       " << s.landmarks << "\n"
      << "loops           " << counter(s, "loops closed") << " closed, "
      << counter(s, "view matches") << " pairs of views, " << counter(s, "worlds joined")
      << " worlds joined\n"
      << "objects         " << s.objects << " (" << s.movingObjects << " moving, "
      << s.texturedObjects << " textured, " << s.objectPoints << " points)\n";
    if (s.localisedAfter) {
        o << "localised       after " << *s.localisedAfter << " frames, map loaded in "
          << s.mapLoad_s.value_or(0) << " s\n";
    }
    if (s.ateSe3_m) {
        o << "ATE             " << std::setprecision(3) << *s.ateSe3_m << std::setprecision(2)
          << " m (SE(3)-aligned RMSE against the drive's ground truth)\n";
    }
    o << "wall time       " << s.wall_s << " s, start-up " << s.startUp_s << " s, peak memory "
      << std::setprecision(0) << s.peakMemory_mb << " MB\n\n"
      << std::setprecision(2) << std::left << std::setw(28) << "stage" << std::right << std::setw(8)
      << "calls" << std::setw(10) << "p50 ms" << std::setw(10) << "p95 ms" << std::setw(10)
      << "max ms" << std::setw(11) << "total s"
      << "\n";
    for (const auto& [stage, t] : s.timings) {
        o << std::left << std::setw(28) << stage << std::right << std::setw(8) << t.count()
          << std::setw(10) << t.p50_ms() << std::setw(10) << t.p95_ms() << std::setw(10)
          << t.max_ms() << std::setw(11) << t.total_ms() / 1000 << "\n";
    }
    for (const auto& [name, count] : s.counters) {
        if (name.rfind("rejected", 0) == 0) o << "warning: " << count << " " << name << "\n";
    }
    if (!s.picture.empty()) o << "no scene.png: " << s.picture << "\n";
    return o.str();
}

}  // namespace djpete::pipeline
