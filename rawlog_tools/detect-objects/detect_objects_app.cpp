#include "detect_objects_app.h"

#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <algorithm>
#include <iostream>

#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete/observers/recorded_observer.h"
#include "djpete_app/command_line.h"
#include "djpete_app/progress_bar.h"
#include "objects_rawlog.h"
#include "segmentation_network.h"

namespace djpete::detect_objects {

using obs::InputError;

namespace {

constexpr const char* kSection = "geometric_observer";
constexpr const char* kHelp =
    "Detects objects in a drive's rawlog and writes them to a companion rawlog, one "
    "CObservationDetectedObjects per frame. The geometric observer finds cars in LiDAR scans by "
    "their shape; the recorded one copies detections that are there already; the network one makes "
    "masks from images, for djpete-eval --silhouettes.";

void loadConfig(const std::string& file, observers::GeometricObserverOptions& options) {
    if (!std::filesystem::is_regular_file(file)) {
        throw InputError(file + ": no such configuration file");
    }
    const mrpt::config::CConfigFile config(file);
    if (!config.sectionExists(kSection)) {
        throw InputError(file + ": expected a section [" + kSection + "]");
    }
    obs::loadOptions(options, config, kSection, file);
}

void printDefaults() {
    mrpt::config::CConfigFileMemory ini;
    observers::GeometricObserverOptions().saveToConfigFile(ini, kSection);
    std::cout << ini.getContent();
}

std::unique_ptr<observers::ObjectObserver> makeObserver(const Job& job) {
    if (job.observer == "geometric") {
        return std::make_unique<observers::GeometricObserver>(job.geometric);
    }
    if (job.observer == "network") return std::make_unique<SegmentationNetwork>(job.network);
    if (job.recordedFrom) return std::make_unique<observers::RecordedObserver>(*job.recordedFrom);
    return std::make_unique<observers::RecordedObserver>();
}

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error) && !error;
}

/// The camera that masks are made for: the drive's main one, else the one of the frame's images.
std::optional<obs::RigCamera> cameraOf(const obs::DriveInfo& info, const obs::SensorFrame& frame) {
    if (info.gray) return info.gray;
    if (info.color) return info.color;
    if (const auto images = frame.loadMainImages()) return images->camera;
    return std::nullopt;
}

}  // namespace

bool DetectObjectsApp::initialize(int argc, const char* const* argv) {
    const auto isPrint = [](const char* word) { return std::string(word) == "--print-config"; };
    if (std::any_of(argv + 1, argv + argc, isPrint)) {  // needs no drive, unlike all else
        printDefaults();
        return false;
    }
    TCLAP::CmdLine cmd(kHelp, ' ', "0.1.0");
    apps::CommandLineOutput output;
    cmd.setOutput(&output);
    using Text = TCLAP::ValueArg<std::string>;
    TCLAP::UnlabeledValueArg<std::string> drive("drive", "The drive's rawlog", true, "",
                                                "DRIVE.rawlog", cmd);
    Text out("o", "out",
             "Rawlog to write (default: DRIVE_objects.rawlog; of a network: DRIVE_masks.rawlog)",
             false, "", "file", cmd);
    Text config("c", "config", "INI with a section [geometric_observer]", false, "", "INI", cmd);
    Text observer("b", "observer", "geometric (default), recorded or network", false, "geometric",
                  "name", cmd);
    Text network("n", "network",
                 "ONNX file of the network observer: YOLOv8 segmentation, COCO's classes", false,
                 "", "file", cmd);
    Text from("f", "from", "Rawlog of detections for the recorded observer", false, "", "file",
              cmd);
    Text range("r", "range", "Frames A to B-1", false, "", "A:B", cmd);
    TCLAP::SwitchArg print("", "print-config",
                           "Print all options with their defaults as an INI and stop", cmd);
    if (!cmd.parse(argc, const_cast<const char**>(argv))) return false;

    job = Job();
    if (config.isSet()) loadConfig(config.getValue(), job.geometric);
    job.drive = drive.getValue();
    job.observer = observer.getValue();
    job.network = network.getValue();
    job.out = out.isSet() ? std::filesystem::path(out.getValue())
                          : companionOf(job.drive, job.observer == "network" ? "masks" : "objects");
    if (from.isSet()) job.recordedFrom = from.getValue();
    job.range = apps::parseFrameRange(range.getValue());
    if (job.observer != "geometric" && job.observer != "recorded" && job.observer != "network") {
        throw InputError("--observer " + job.observer +
                         ": expected geometric, recorded or network");
    }
    if ((job.observer == "network") != network.isSet()) {
        throw InputError("--observer network and --network need each other");
    }
    if (job.recordedFrom && job.observer != "recorded") {
        throw InputError("--from is for --observer recorded");
    }
    return true;
}

void DetectObjectsApp::run(std::ostream& out) {
    report = Report();
    obs::RawlogSource source(job.drive);
    const auto observer = makeObserver(job);
    if (sameFile(job.out, job.drive) ||
        (job.recordedFrom && sameFile(job.out, *job.recordedFrom))) {
        throw InputError(job.out.string() +
                         ": would overwrite its own input; choose another --out");
    }
    ObjectsRawlog rawlog(job.out);
    const obs::DriveInfo& info = source.info();
    apps::ProgressBar progress;
    for (uint64_t read = 1; auto frame = source.next(); ++read) {
        if (frame->id.value >= job.range.end) break;
        if (!job.range.contains(frame->id.value)) continue;
        ++report.frames;
        std::optional<obs::LidarScan> scan;
        std::optional<obs::RigCamera> camera;
        if (job.observer == "geometric") {
            scan = frame->loadScan();
            if (scan) camera = cameraOf(info, *frame);
        }
        const auto objects =
            observer->observe(*frame, scan ? &*scan : nullptr, camera ? &*camera : nullptr);
        frame->unload();
        if (objects) {
            rawlog.write(*objects);
            ++report.observed;
            report.detections += objects->detections.size();
        }
        progress.show(read,
                      info.frameCount - std::min<uint64_t>(info.frameCount, info.missing.size()));
    }
    progress.finish();
    out << job.out.string() << ": " << report.detections << " objects in " << report.observed
        << " of " << report.frames << " frames (" << observer->name() << ")\n";
    if (report.frames == 0) {
        throw InputError(job.drive.string() + ": no frame in the range asked for");
    }
}

}  // namespace djpete::detect_objects
