#include "djpete_eval_app.h"

#include <ostream>

#include "ablation.h"
#include "djpete/evaluation/camera_path.h"
#include "eval_command_line.h"
#include "tracking_files.h"
#include "tracking_report.h"

namespace djpete::apps {

using namespace evaluation;
bool DjpeteEvalApp::initialize(int argc, const char** argv) {
    const auto asked = parseCommandLine(argc, argv);
    if (!asked) return false;
    settings = *asked;
    requireConsistent(settings);
    return true;
}

void DjpeteEvalApp::run(std::ostream& out) {
    results = {};
    if (!settings.textures.resultFolder.empty()) {
        out << textureReport(settings.textures, settings.json);
        return;
    }
    if (!settings.silhouettes.resultFolder.empty()) {
        out << silhouetteReport(settings.silhouettes, settings.json);
        return;
    }
    if (settings.figures) {
        runFigures(*settings.figures, out);
        return;
    }
    if (!settings.ablationFolders.empty()) {
        std::vector<AblationDrive> drives;
        for (const auto& folder : settings.ablationFolders) {
            drives.push_back(
                readAblation(folder, {settings.range, settings.criteria, settings.worldFromTruth}));
        }
        out << (settings.json ? ablationJson(drives) : ablationTable(drives));
        return;
    }
    if (!settings.trackingFiles.empty()) {
        const auto errors = evaluateTracking(
            readTrackingPairs(settings.trackingFiles, settings.labelsFiles, settings.range),
            settings.trackingCriteria);
        out << (settings.json ? trackingJson(errors) : trackingTable(errors));
        return;
    }
    const TrajectoryFile estimate = readTrajectory(settings.trajectoryFile);
    std::optional<TrajectoryFile> truth;
    results.frames = settings.range ? settings.range->size() : estimate.poses.size();
    if (settings.truthFile) {
        truth = readTrajectory(*settings.truthFile);
        const auto pair = pairTrajectories(estimate, *truth, settings.range);
        results.trajectory = evaluateTrajectory(pair.estimate, pair.truth);
    }
    if (settings.loopsFile) {
        results.loops =
            evaluateLoops(readLoopsCsv(*settings.loopsFile), truth->poses, *settings.loopsFile);
    }
    if (settings.objectsFile) evaluateObjects(estimate, truth);
    out << (settings.json ? jsonReport(results) : textReport(results));
}

void DjpeteEvalApp::evaluateObjects(const TrajectoryFile& estimate,
                                    const std::optional<TrajectoryFile>& truth) {
    const ObjectsFile objects = readObjectsCsv(*settings.objectsFile);
    const auto labels = readTrackingLabels(settings.labelsFiles.front());
    const CameraPath estimated = estimatedCameras(objects, estimate, settings.range);
    const CameraPath best =
        truth ? trueCameras(objects, *truth, estimated, settings.range) : estimated;
    results.objects = evaluation::evaluateObjects(
        objects.rows, labels, settings.worldFromTruth ? best : estimated, best, settings.criteria);
}

}  // namespace djpete::apps
