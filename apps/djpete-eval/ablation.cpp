#include "ablation.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "djpete/evaluation/camera_path.h"
#include "djpete/obs/errors.h"

namespace djpete::apps {

using namespace evaluation;
namespace fs = std::filesystem;

namespace {

constexpr const char* kPath = "trajectory.kitti.txt";

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw obs::InputError(file.string() + ": cannot be opened for reading");
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

ObjectErrors objectErrors(const fs::path& objectsFile, const TrajectoryFile& estimate,
                          const TrajectoryFile& truth, const std::vector<LabelBox>& labels,
                          const AblationOptions& options) {
    const ObjectsFile objects = readObjectsCsv(objectsFile.string());
    const CameraPath own = estimatedCameras(objects, estimate, options.range);
    const CameraPath trueOnes = trueCameras(objects, truth, own, options.range);
    return evaluateObjects(objects.rows, labels, options.worldFromTruth ? trueOnes : own, trueOnes,
                           options.criteria);
}

}  // namespace

AblationDrive readAblation(const std::string& folder, const AblationOptions& options) {
    const fs::path path = folder;
    if (!fs::is_directory(path)) {
        throw obs::InputError(folder + ": expected a folder with off, worker, joint and truth.txt");
    }
    const TrajectoryFile truth = readTrajectory((path / "truth.txt").string());
    std::optional<std::vector<LabelBox>> labels;
    if (fs::exists(path / "labels.txt")) {
        labels = readTrackingLabels((path / "labels.txt").string());
    }
    AblationDrive drive;
    drive.name = fs::canonical(path).filename().string();
    for (const char* mode : {"off", "worker", "joint"}) {
        const fs::path run = path / mode;
        const TrajectoryFile estimate = readTrajectory((run / kPath).string());
        const auto pair = pairTrajectories(estimate, truth, options.range);
        AblationRun result;
        result.mode = mode;
        result.trajectory = evaluateTrajectory(pair.estimate, pair.truth);
        result.samePathAsOff = bytesOf(run / kPath) == bytesOf(path / "off" / kPath);
        const bool noObjects = drive.runs.empty() && !fs::exists(run / "objects.csv");
        if (labels && !noObjects) {
            result.objects = objectErrors(run / "objects.csv", estimate, truth, *labels, options);
        }
        drive.runs.push_back(std::move(result));
    }
    return drive;
}

}  // namespace djpete::apps
