/// What a run leaves behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "djpete/pipeline/object_slam.h"

namespace djpete::pipeline {

/// The figures of one run.
struct RunSummary {
    std::string drive;
    uint64_t frames = 0, tracked = 0, keyframes = 0, landmarks = 0;
    uint64_t objects = 0, movingObjects = 0, texturedObjects = 0, objectPoints = 0;
    double pathLength_m = 0;
    /// With a map to go on from: frames until the camera knew where it is in it.
    std::optional<uint64_t> localisedAfter;
    /// SE(3)-aligned, against the drive's own ground truth if it carries one.
    std::optional<double> ateSe3_m;
    double wall_s = 0;
    std::optional<double> mapLoad_s;  ///< with a map to go on from: until it is ready
    double startUp_s = 0;             ///< until the first frame was at hand
    double peakMemory_mb = 0;         ///< largest resident memory, images and program included
    std::string picture;              ///< empty, or why there is no scene.png
    std::string error;                ///< empty, or the sentence that ended the run early
    StageTable timings;
    std::map<std::string, uint64_t> counters;
};

/// Writes trajectory.tum, trajectory.kitti.txt, objects.csv, tracking.txt, loops.csv, map.graph,
/// background.ot and .bt if there is an octree, objects/*.ply
/// and objects/*.object (see texture/object_file.h), exposures.csv, scene.3Dscene, scene.png and
/// summary.json into `folder` (made if missing) and fills the figures that the map holds.
/// Everything but the times in summary.json is the same for the same drive and options. Throws
/// obs::InputError naming the file that cannot be written.
void writeResults(const ObjectSlam& slam, const ObjectSlamOptions& options,
                  const std::filesystem::path& folder, RunSummary& summary);

/// The summary as a table for people.
std::string toText(const RunSummary& summary);

}  // namespace djpete::pipeline
