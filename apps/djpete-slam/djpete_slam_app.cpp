#include "djpete_slam_app.h"

#include <sys/resource.h>

#include <chrono>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "djpete/calibration/check_drive.h"
#include "djpete/evaluation/trajectory_errors.h"
#include "djpete/io/ply_writer.h"
#include "djpete/obs/errors.h"
#include "djpete/observers/recorded_observer.h"
#include "djpete_app/command_line.h"
#include "djpete_app/progress_bar.h"

namespace djpete::apps {

namespace {

namespace fs = std::filesystem;

constexpr const char* kVersion = "0.1.0";

/// `<drive>_objects.rawlog` beside the drive.
fs::path companionOf(const fs::path& rawlog) {
    return rawlog.parent_path() / (rawlog.stem().string() + "_objects.rawlog");
}

/// Largest resident memory so far, MB.
double peakMemory_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

struct DjpeteSlamApp::Arguments {
    fs::path rawlog, objects, map, saveMap;
    bool localise = false;
    pipeline::ObjectSlamOptions options;
    FrameRange range;
    bool quiet = false, checkCalibration = false;
};

DjpeteSlamApp::DjpeteSlamApp() = default;
DjpeteSlamApp::~DjpeteSlamApp() = default;

bool DjpeteSlamApp::initialize(int argc, const char* const* argv) {
    TCLAP::CmdLine cmd(
        "Object-level SLAM: reads a drive from a rawlog (see "
        "kitti2rawlog) and writes the camera "
        "trajectory, the map, and every car as a textured object",
        ' ', kVersion);
    // One list: TCLAP's optional positional arguments are a process-wide state.
    TCLAP::UnlabeledMultiArg<std::string> files(
        "files", "INI file with the tuning (datasets_cfg/), then the rawlog of the drive", true,
        "CONFIG.ini DRIVE.rawlog", cmd);
    TCLAP::ValueArg<std::string> out("", "out", "result folder (default: DRIVE_djpete beside it)",
                                     false, "", "DIR", cmd);
    TCLAP::ValueArg<std::string> objects(
        "", "objects", "recorded detections (default: DRIVE_objects.rawlog if it exists)", false,
        "", "FILE", cmd);
    TCLAP::ValueArg<std::string> observer("", "observer",
                                          "auto, recorded, geometric or none; overrides the INI",
                                          false, "", "NAME", cmd);
    TCLAP::ValueArg<std::string> mode("", "mode", "threaded or lockstep; overrides the INI", false,
                                      "", "NAME", cmd);
    TCLAP::ValueArg<int> threads("", "threads",
                                 "threads for images; no influence on results (default: all cores)",
                                 false, 0, "N", cmd);
    TCLAP::ValueArg<std::string> range("", "range", "frames A to B-1 only", false, "", "A:B", cmd);
    TCLAP::ValueArg<std::string> map(
        "m", "map", "map file of earlier drives to go on from; this drive finds its place in it",
        false, "", "FILE", cmd);
    TCLAP::SwitchArg localise(
        "", "localise", "only say where the camera is in --map; its poses stay as they are", cmd);
    TCLAP::ValueArg<std::string> saveMap("", "save-map", "write the map at the end, as .djmap",
                                         false, "", "FILE", cmd);
    TCLAP::SwitchArg print("", "print-config", "print every option with its value and leave", cmd);
    TCLAP::SwitchArg check("", "check-calibration",
                           "print what the drive's images and scans say of its rig, and leave",
                           cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "no progress, no table", cmd);
    CommandLineOutput output;
    cmd.setOutput(&output);
    // False after --help and --version; failures leave through `output`.
    if (!cmd.parse(argc, const_cast<const char**>(argv))) return false;

    for (const auto& word : files.getValue()) {
        if (word.rfind("-", 0) == 0) {
            throw obs::InputError("command line: unknown option " + word + "; see --help");
        }
    }
    arguments_ = std::make_unique<Arguments>();
    auto& options = arguments_->options;
    options = pipeline::ObjectSlamOptions::fromFile(files.getValue().front());
    std::ostringstream overrides;
    overrides << "[pipeline]\n";
    if (observer.isSet()) overrides << "observer = " << observer.getValue() << "\n";
    if (threads.isSet()) overrides << "threads = " << threads.getValue() << "\n";
    if (mode.isSet()) overrides << "mode = " << mode.getValue() << "\n";
    options.overridePipeline(overrides.str(), "command line");
    if (print.getValue()) {
        std::cout << options.toText();
        return false;
    }
    if (files.getValue().size() != 2) {
        throw obs::InputError("command line: expected CONFIG.ini DRIVE.rawlog; see --help");
    }
    arguments_->rawlog = files.getValue().back();
    arguments_->objects = objects.getValue();
    arguments_->map = map.getValue();
    arguments_->saveMap = saveMap.getValue();
    arguments_->localise = localise.getValue();
    if (localise.getValue() && !map.isSet()) {
        throw obs::InputError("command line: --localise needs --map");
    }
    if (localise.getValue() && saveMap.isSet()) {
        throw obs::InputError(
            "command line: --localise leaves the map as it is, so there is nothing for --save-map");
    }
    if (map.isSet() && !options.backend.recognition.loops.enabled) {
        throw obs::InputError(
            "command line: --map needs places to be known again; expected enabled = true in "
            "section [loops]");
    }
    arguments_->range = parseFrameRange(range.getValue());
    arguments_->quiet = quiet.getValue();
    arguments_->checkCalibration = check.getValue();
    outFolder = out.isSet() ? fs::path(out.getValue())
                            : arguments_->rawlog.parent_path() /
                                  (arguments_->rawlog.stem().string() + "_djpete");
    return true;
}

std::unique_ptr<observers::ObjectObserver> DjpeteSlamApp::makeObserver() const {
    const auto& options = arguments_->options;
    std::string kind = options.pipeline.observer;
    fs::path file = arguments_->objects;
    if (!file.empty() && kind == "auto") kind = "recorded";
    if (file.empty() && fs::exists(companionOf(arguments_->rawlog))) {
        file = companionOf(arguments_->rawlog);
        if (kind == "auto") kind = "recorded";
    }
    if (kind == "none") return nullptr;
    if (kind == "recorded") {
        if (file.empty()) return std::make_unique<observers::RecordedObserver>();
        return std::make_unique<observers::RecordedObserver>(file);
    }
    return std::make_unique<observers::GeometricObserver>(options.geometric);
}

calibration::CalibrationReport DjpeteSlamApp::checkRig() const {
    const auto& args = *arguments_;
    return calibration::checkDrive(args.rawlog, args.options.frontend, args.range.begin,
                                   args.range.end);
}

std::string DjpeteSlamApp::note(const pipeline::FrameOutcome& outcome) const {
    return std::to_string(outcome.features) + " features, " +
           std::to_string(slam->map().objects().size()) + " objects" +
           (outcome.tracked ? "" : ", LOST");
}

void DjpeteSlamApp::processDrive(obs::RawlogSource& source) {
    const auto& args = *arguments_;
    pipeline::FramePrefetcher frames(source, {args.range.begin}, {args.range.end});
    ProgressBar progress;
    uint64_t done = 0;
    try {
        while (auto frame = frames.next()) {
            if (done == 0) summary.startUp_s = sinceStart_s();
            if (frame->frame.T_world_vehicle_truth) {
                truth_[frame->frame.id] = *frame->frame.T_world_vehicle_truth;
            }
            if (correction_ && frame->images) frame->images = correction_->apply(*frame->images);
            const auto outcome = slam->process(*frame);
            ++done;
            if (!args.map.empty() && outcome.localised && !summary.localisedAfter) {
                summary.localisedAfter = done;
            }
            if (!args.quiet) progress.show(done, source.info().frameCount, note(outcome));
        }
    } catch (const obs::InputError& e) {
        summary.error = e.what();
    }
    progress.finish();
}

void DjpeteSlamApp::compareWithTruth() {
    evaluation::Trajectory estimate, truth;
    for (const auto& [frame, T_world_vehicle] : truth_) {
        const auto T_world_cam = slam->map().cameraAt(slam->frameInMap(frame));
        const auto* first =
            slam->map().keyframes().empty() ? nullptr : &slam->map().keyframes().begin()->second;
        if (!T_world_cam || !first) continue;
        estimate.push_back(*T_world_cam);
        truth.push_back(T_world_vehicle * first->T_vehicle_cam);
    }
    if (estimate.size() < 3) return;
    summary.ateSe3_m = evaluation::evaluateTrajectory(estimate, truth).ate_se3_m;
}

void DjpeteSlamApp::openMap() {
    if (arguments_->map.empty()) return;
    const double begin_s = sinceStart_s();
    map::LoadedMap loaded = map::loadMap(arguments_->map);
    mapInfo_ = std::move(loaded.info);
    slam->continueFrom(std::move(loaded.map), arguments_->localise);
    summary.mapLoad_s = sinceStart_s() - begin_s;
}

void DjpeteSlamApp::saveMap() {
    const fs::path& file = arguments_->saveMap;
    if (file.empty()) return;
    if (mapInfo_.drive.empty()) mapInfo_.drive = summary.drive;
    mapInfo_.sessions.push_back(summary.drive);
    mapInfo_.toolVersion = kVersion;
    // Textures that were in the map before stay where they are; those of this drive lie in the
    // result folder, and are named if the map lies above it.
    const auto& objectsLeft = slam->map().objects();
    for (auto it = mapInfo_.textures.begin(); it != mapInfo_.textures.end();) {
        it = objectsLeft.count(it->first) == 0 ? mapInfo_.textures.erase(it) : std::next(it);
    }
    const fs::path folder = fs::absolute(outFolder).lexically_normal();
    const fs::path home = fs::absolute(file).lexically_normal().parent_path();
    for (const auto& [id, name] : io::objectPlyNames(slam->models())) {
        const fs::path relative = (folder / "objects" / name).lexically_relative(home);
        if (relative.empty() || *relative.begin() == "..") continue;
        mapInfo_.textures[id] = relative.generic_string();
    }
    map::saveMap(slam->map(), file, mapInfo_);
}

int DjpeteSlamApp::run() {
    const auto& args = *arguments_;
    if (args.checkCalibration) {
        std::cout << calibration::toText(checkRig());
        return 0;
    }
    obs::RawlogSource source(args.rawlog);
    if (args.options.pipeline.selfCalibrate) {
        correction_ = calibration::corrected(source.info().mainCamera(source.path()), checkRig());
        source = obs::RawlogSource(args.rawlog);
    }
    slam = std::make_unique<pipeline::ObjectSlam>(args.options, makeObserver());
    if (source.info().gray || source.info().color) {
        slam->setRig(correction_ ? correction_->camera : source.info().mainCamera(source.path()));
    }
    summary.drive = source.info().name;
    openMap();
    processDrive(source);
    slam->finish();
    compareWithTruth();
    summary.wall_s = sinceStart_s();
    summary.peakMemory_mb = peakMemory_mb();
    pipeline::writeResults(*slam, args.options, outFolder, summary);
    saveMap();
    if (!args.quiet)
        std::cout << pipeline::toText(summary) << "results in " << outFolder.string() << "\n";
    if (summary.error.empty() && summary.frames == 0) {
        summary.error = args.rawlog.string() + ": no frame in the asked range";
    }
    if (summary.error.empty()) return 0;
    std::cerr << "djpete-slam: " << summary.error << std::endl;
    return 1;
}

}  // namespace djpete::apps
