#include "eval_settings.h"

#include "djpete/obs/errors.h"

namespace djpete::apps {

using evaluation::MotionSelection;
using evaluation::OverlapKind;
using obs::InputError;

namespace {

/// Any of the files that other tasks compare.
bool hasOtherFiles(const EvalSettings& s) {
    return !s.trajectoryFile.empty() || s.truthFile || s.objectsFile || s.loopsFile ||
           !s.labelsFiles.empty() || !s.trackingFiles.empty() || !s.ablationFolders.empty() ||
           s.range;
}

}  // namespace

void requireConsistent(const EvalSettings& s) {
    if (s.figures) {
        if (!s.trajectoryFile.empty() || s.objectsFile || s.loopsFile || s.range || s.json ||
            !s.labelsFiles.empty() || !s.trackingFiles.empty() || !s.ablationFolders.empty() ||
            !s.textures.resultFolder.empty() || !s.silhouettes.resultFolder.empty()) {
            throw InputError(
                "command line: --figures goes with --result, --drive and --truth only");
        }
        return;
    }
    if (!s.silhouettes.resultFolder.empty()) {
        if (s.silhouettes.detections.empty()) {
            throw InputError(
                "command line: --silhouettes needs --drive with the rawlog of masks or boxes");
        }
        if (hasOtherFiles(s) || !s.textures.resultFolder.empty() || s.textures.rebuild ||
            !s.textures.curveFile.empty()) {
            throw InputError(
                "command line: --silhouettes goes with --drive, --rawlog, --strips, --disturb and "
                "--json only");
        }
        return;
    }
    if (s.textures.resultFolder.empty() != s.textures.driveFolder.empty()) {
        throw InputError(
            "command line: --textures and --drive need each other (or --drive and --figures)");
    }
    if (!s.textures.resultFolder.empty()) {
        if (hasOtherFiles(s)) {
            throw InputError(
                "command line: --textures goes with --drive, --rawlog, --rebuild, --curve, "
                "--strips, --disturb and --json only");
        }
        return;
    }
    if (s.textures.rawlog || s.textures.disturbance.any() || s.textures.rebuild ||
        !s.textures.stripFolder.empty() || !s.textures.curveFile.empty()) {
        throw InputError(
            "command line: --rawlog, --rebuild, --curve, --strips and --disturb need --textures "
            "(--rawlog, --strips and --disturb: or --silhouettes)");
    }
    if (s.trackingFiles.empty() && s.trackingCriteria.overlap == OverlapKind::BirdsEye) {
        throw InputError("command line: --bev needs --tracking");
    }
    if (!s.ablationFolders.empty()) {
        if (!s.trajectoryFile.empty() || s.truthFile || s.objectsFile || s.loopsFile ||
            !s.labelsFiles.empty() || !s.trackingFiles.empty()) {
            throw InputError(
                "command line: --ablation takes no other files; each folder holds truth.txt and "
                "labels.txt");
        }
        return;
    }
    if (!s.trackingFiles.empty()) {
        if (s.labelsFiles.empty()) throw InputError("command line: --tracking needs --labels");
        if (!s.trajectoryFile.empty() || s.truthFile || s.objectsFile || s.loopsFile) {
            throw InputError(
                "command line: --tracking goes with --labels, --bev, --range and --json only");
        }
        return;
    }
    if (s.trajectoryFile.empty()) {
        throw InputError(
            "command line: --trajectory, --tracking, --ablation, --textures, --silhouettes or "
            "--figures "
            "is required; see --help");
    }
    const bool objects = s.objectsFile.has_value();
    if (objects == s.labelsFiles.empty()) {
        throw InputError("command line: --objects and --labels need each other");
    }
    if (s.labelsFiles.size() > 1) {
        throw InputError("command line: expected one file of --labels with --objects, got " +
                         std::to_string(s.labelsFiles.size()));
    }
    if (!objects && !s.truthFile) {
        throw InputError("command line: expected --truth, or --objects with --labels, or both");
    }
    if (!s.truthFile && s.loopsFile) {
        throw InputError("command line: --loops needs --truth");
    }
    if (!s.truthFile && s.worldFromTruth) {
        throw InputError("command line: --world-from-truth needs --truth");
    }
    if (!s.truthFile && s.criteria.motion != MotionSelection::All) {
        throw InputError("command line: --static-only and --moving-only need --truth");
    }
}

}  // namespace djpete::apps
